//! `[[constraints]]`: the names of constraints, and the call of the function that adds each kind.

use super::Assembly;
use crate::model::constraint::constraint_kinds;
use crate::model::{Constraint, Name, Named};
use crate::tree::Node;

macro_rules! add_constraint {
    ($($kind:ident => $add:ident,)*) => {
        fn add_constraint(&mut self, constraint: &Constraint, place: &Node) -> Option<()> {
            match constraint {
                $(Constraint::$kind(it) => self.$add(it, place),)*
            }
        }
    };
}

impl Assembly<'_, '_, '_> {
    constraint_kinds!(add_constraint);

    pub(super) fn add_constraints(&mut self, constraints: &[Constraint]) {
        for (index, constraint) in constraints.iter().enumerate() {
            let place = self.tree.key("constraints").item(index);
            self.adding = place.span.clone();
            let before = self.builder.constraint_count();
            self.add_constraint(constraint, place);
            self.made.constraints.push(before..self.builder.constraint_count());
        }
        self.adding = 0..0;
    }

    /// Adds a constraint under the name that the scene gives it, or under its default name.
    pub(super) fn add_named(&mut self, it: &impl Named, constraint: impl Into<qhat::Constraint>) {
        let name = self.name_of(it);
        self.builder.constraint(name, constraint);
    }

    /// The name that the scene gives a constraint, or else its default name.
    pub(super) fn name_of(&mut self, it: &impl Named) -> String {
        match it.id() {
            Some(Name(name)) => {
                self.note_place(name);
                name.clone()
            }
            None => self.free_name(it.default_name()),
        }
    }

    /// The name, with a number behind it where it is taken: two rods between the same particles are allowed.
    pub(super) fn free_name(&mut self, wanted: String) -> String {
        let name = self.first_free_name(wanted);
        self.note_place(&name);
        name
    }

    fn first_free_name(&mut self, wanted: String) -> String {
        if self.constraint_names.insert(wanted.clone()) {
            return wanted;
        }
        // Names are never given back, so the search goes on where the last one for this name ended: a thousand equal
        // names take a thousand tries.
        let number = self.next_numbers.entry(wanted.clone()).or_insert(2);
        loop {
            let name = format!("{wanted}({number})");
            *number += 1;
            if self.constraint_names.insert(name.clone()) {
                return name;
            }
        }
    }

    /// Keeps the place of a constraint for errors that only the engine finds.
    fn note_place(&mut self, name: &str) {
        if !self.adding.is_empty() {
            self.places.insert(name.to_owned(), self.adding.clone());
        }
    }

    /// Takes the names that the scene gives, before any default name is made.
    pub(super) fn take_constraint_names(&mut self, constraints: &[Constraint]) {
        for (index, constraint) in constraints.iter().enumerate() {
            if let Some(Name(name)) = constraint.id()
                && !self.constraint_names.insert(name.clone())
            {
                let span = self.tree.key("constraints").item(index).key("id").span.clone();
                let message = format!("the id {} is given to two constraints", self.report.quoted(name));
                self.report.error(span, message, Some("each constraint needs an id of its own".into()));
            }
        }
    }

    /// Reports a constraint that needs one of two keys and has both or neither. Reports nothing where a key is written
    /// but missing in the model, because the check against the schema has refused the key already.
    pub(super) fn needs_one(&mut self, place: &Node, kind: &str, keys: [&str; 2], both: bool) {
        let [one, other] = keys;
        if !both && keys.iter().any(|key| place.get(key).is_some()) {
            return;
        }
        let what = if both { "not both" } else { "but has neither" };
        let message = format!("a {kind} is given by `{one}` or by `{other}`, {what}");
        let help = if both { format!("leave out `{one}` or `{other}`") } else { format!("add `{one}` or `{other}`") };
        self.report.error(place.span.clone(), message, Some(help));
    }
}
