//! The text of a framework as a scene, in TOML or JSON.

use crate::formula::Formula;
use crate::framework::{Condition, Framework, Push};
use crate::random::Random;
use qhat_scene::Format;

/// The format of a seed: half of the seeds are in each, in every family.
pub fn format_of(seed: u64) -> Format {
    if Random::new(seed).chance(0.5) { Format::Toml } else { Format::Json }
}

/// A value of a scene.
#[derive(Clone, Debug)]
pub enum Value {
    /// A text.
    Text(String),
    /// A number.
    Number(f64),
    /// A whole number.
    Whole(usize),
    /// A truth value.
    Flag(bool),
    /// A list.
    List(Vec<Value>),
    /// A table, in the order of its keys.
    Table(Vec<(String, Value)>),
}

fn text(text: impl Into<String>) -> Value {
    Value::Text(text.into())
}

fn table<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Table(entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}

impl Value {
    /// The value in a format. TOML 1.0 keeps inner tables on one line, so no line is broken in either.
    fn write(&self, format: Format, out: &mut String) {
        let equals = if format == Format::Json { ": " } else { " = " };
        let mut join = |open: char, close: char, count: usize, each: &mut dyn FnMut(usize, &mut String)| {
            out.push(open);
            for i in 0..count {
                if i > 0 {
                    out.push_str(", ");
                }
                each(i, out);
            }
            out.push(close);
        };
        match self {
            // Texts of frameworks have no character that either format escapes.
            Value::Text(text) => *out += &format!("\"{text}\""),
            Value::Number(number) => *out += &format!("{number:?}"),
            Value::Whole(number) => *out += &format!("{number}"),
            Value::Flag(flag) => *out += &format!("{flag}"),
            Value::List(items) => join('[', ']', items.len(), &mut |i, out| items[i].write(format, out)),
            Value::Table(entries) => join('{', '}', entries.len(), &mut |i, out| {
                let (key, value) = &entries[i];
                *out += &format!("\"{key}\"{equals}");
                value.write(format, out);
            }),
        }
    }
}

impl Framework {
    /// The scene as text.
    pub fn text(&self, format: Format) -> String {
        let json = format == Format::Json;
        let mut out = String::new();
        for (i, (key, value)) in self.scene().iter().enumerate() {
            let before = if !json {
                ""
            } else if i == 0 {
                "{"
            } else {
                ",\n"
            };
            let equals = if json { ": " } else { " = " };
            let key = if json { format!("\"{key}\"") } else { key.clone() };
            out += &format!("{before}{key}{equals}");
            match value {
                // One entry of a list a line, for people who read a finding. JSON and TOML both allow it.
                Value::List(items) if matches!(items.first(), Some(Value::Table(_))) => {
                    for (i, item) in items.iter().enumerate() {
                        out.push_str(if i == 0 { "[\n  " } else { ",\n  " });
                        item.write(format, &mut out);
                    }
                    out.push_str("\n]");
                }
                _ => value.write(format, &mut out),
            }
            if !json {
                out.push('\n');
            }
        }
        if json {
            out.push_str("}\n");
        }
        out
    }

    fn names(&self) -> impl Fn(usize) -> String + '_ {
        |particle| self.particles[particle].name.clone()
    }

    fn formula(&self, formula: &Formula) -> Value {
        match formula {
            Formula::Number(number) => Value::Number(*number),
            _ => text(formula.text(&self.names())),
        }
    }

    fn formulas_of(&self, formulas: &[Formula]) -> Value {
        Value::List(formulas.iter().map(|formula| text(formula.text(&self.names()))).collect())
    }

    fn vector(&self, vector: &[f64; 3]) -> Value {
        Value::List(vector[..self.dimension].iter().map(|component| Value::Number(*component)).collect())
    }

    fn between(&self, between: [usize; 2]) -> Value {
        Value::List(between.map(|particle| self.particle(particle)).to_vec())
    }

    fn particle(&self, particle: usize) -> Value {
        text(self.particles[particle].name.clone())
    }

    /// The keys of the scene, in the order of the text.
    fn scene(&self) -> Vec<(String, Value)> {
        let mut entries = vec![
            ("schema".to_owned(), text("qhat/1")),
            ("name".to_owned(), text(format!("Seed {}, {}", self.seed, self.family))),
            ("dimension".to_owned(), Value::Whole(self.dimension)),
        ];
        let mut put = |key: &str, value| entries.push((key.to_owned(), value));
        if !self.parameters.is_empty() {
            let named = self.parameters.iter().map(|(name, value)| (name.clone(), Value::Number(*value)));
            put("parameters", Value::Table(named.collect()));
        }
        put(
            "step",
            table([
                ("h", Value::Number(self.duration / 4.0)),
                ("duration", Value::Number(self.duration)),
                ("integrator", text("dop853")),
                ("tolerance", Value::Number(1e-10)),
            ]),
        );
        put("forces", table([("gravity", self.vector(&self.gravity)), ("drag", Value::Number(self.drag))]));
        let particles = self.particles.iter().map(|particle| {
            let name = ("id", text(particle.name.clone()));
            let at = ("at", self.vector(&particle.at));
            let mass = ("mass", Value::Number(particle.mass));
            if particle.fixed {
                return table([name, at, mass, ("fixed", Value::Flag(true))]);
            }
            table([name, at, mass, ("velocity", self.vector(&particle.velocity))])
        });
        put("particles", Value::List(particles.collect()));
        put("constraints", Value::List(self.conditions.iter().map(|condition| self.condition(condition)).collect()));
        let springs = self.pushes.iter().filter_map(|push| self.spring(push));
        put("springs", Value::List(springs.collect()));
        put("loads", Value::List(self.pushes.iter().filter_map(|push| self.load(push)).collect()));
        entries
    }

    fn condition(&self, condition: &Condition) -> Value {
        match condition {
            Condition::Rod { between, length, squared } => {
                let kind = ("kind", text("distance"));
                let ends = ("between", self.between(*between));
                let length = ("length", self.formula(length));
                if *squared {
                    return table([kind, ends, length, ("form", text("squared"))]);
                }
                table([kind, ends, length])
            }
            Condition::Nail { particle, at } => table([
                ("kind", text("nail")),
                ("particle", self.particle(*particle)),
                ("at", Value::List(at.iter().map(|at| self.formula(at)).collect())),
            ]),
            Condition::Coincidence { between } => {
                table([("kind", text("coincidence")), ("between", self.between(*between))])
            }
            Condition::Expression { rows } => {
                table([("kind", text("expression")), ("residual", self.formulas_of(rows))])
            }
        }
    }

    fn spring(&self, push: &Push) -> Option<Value> {
        let Push::Spring { between, stiffness, damping, rest } = push else { return None };
        Some(table([
            ("between", self.between(*between)),
            ("stiffness", Value::Number(*stiffness)),
            ("damping", Value::Number(*damping)),
            ("rest", Value::Number(*rest)),
        ]))
    }

    fn load(&self, push: &Push) -> Option<Value> {
        Some(match push {
            Push::Spring { .. } => return None,
            Push::Point(particle, force) => {
                table([("kind", text("point")), ("particle", self.particle(*particle)), ("force", self.vector(force))])
            }
            Push::Harmonic(particle, force, frequency, phase) => table([
                ("kind", text("harmonic")),
                ("particle", self.particle(*particle)),
                ("force", self.vector(force)),
                ("angular_frequency", Value::Number(*frequency)),
                ("phase", Value::Number(*phase)),
            ]),
            Push::Force(particle, force) => table([
                ("kind", text("force")),
                ("particle", self.particle(*particle)),
                ("force", self.formulas_of(force)),
            ]),
            Push::Potential(potential) => {
                table([("kind", text("potential")), ("potential", text(potential.text(&self.names())))])
            }
        })
    }
}
