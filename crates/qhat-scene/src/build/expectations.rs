//! `[expect]`: checks that the particles, rods and constraints exist that it names.

use super::Assembly;
use crate::model::{Axis, Expect, Id};
use crate::suggest::nearest;
use crate::tree::Node;

impl Assembly<'_, '_, '_> {
    pub(super) fn check_expectations(&mut self, expect: &Expect) {
        let place = self.tree.key("expect");
        if let Some(period) = &expect.period {
            self.check_watched(&period.particle, period.axis, place.key("period"));
        }
        for (index, motion) in expect.motion.iter().enumerate() {
            let place = place.key("motion").item(index);
            self.check_watched(&motion.particle, motion.axis, place);
            for (key, range) in [("within", motion.within), ("covers", motion.covers)] {
                if range.is_some_and(|[low, high]| low > high) {
                    let message = format!("`{key}` must begin with the lower end");
                    self.report.error(place.key(key).span.clone(), message, Some("exchange the two numbers".into()));
                }
            }
        }
        for (index, end) in expect.at_end.iter().enumerate() {
            self.check_watched(&end.particle, end.axis, place.key("at_end").item(index));
        }
        for (index, end) in expect.speed_at_end.iter().enumerate() {
            let place = place.key("speed_at_end").item(index);
            self.particle(&Id(end.particle.clone()), place.key("particle"));
        }
        for (index, tension) in expect.tension.iter().enumerate() {
            self.check_name("rod", &tension.rod, place.key("tension").item(index).key("rod"));
        }
        for (index, name) in expect.broken.iter().flatten().enumerate() {
            self.check_name("constraint", name, place.key("broken").item(index));
        }
    }

    fn check_name(&mut self, what: &str, name: &str, place: &Node) {
        if self.constraint_names.contains(name) {
            return;
        }
        let message = format!("there is no {what} {}", self.report.quoted(name));
        let mut names: Vec<&str> = self.constraint_names.iter().map(String::as_str).collect();
        names.sort_unstable();
        let help = match nearest(name, names.into_iter()) {
            Some(name) => format!("did you mean `{name}`?"),
            None => "a rod without `id` is named after its ends, as in `a-b`".to_owned(),
        };
        self.report.error(place.span.clone(), message, Some(help));
    }

    fn check_watched(&mut self, particle: &str, axis: Axis, place: &Node) {
        self.particle(&Id(particle.to_owned()), place.key("particle"));
        if axis.index() >= self.dimension {
            let message = "there is no axis `z` in two dimensions";
            self.report.error(place.key("axis").span.clone(), message, Some("use `x` or `y`".into()));
        }
    }
}
