//! `[[constraints]]` between several lengths: ropes over pulleys and lengths in a ratio.

use super::Assembly;
use crate::model::lengths::{LengthRatio, Pulley};
use crate::tree::Node;
use qhat::Lengths;

impl Assembly<'_, '_, '_> {
    pub(super) fn add_pulley(&mut self, it: &Pulley, place: &Node) -> Option<()> {
        let points = self.particles(&it.over, place.key("over"))?;
        let stretches = points.len() - 1;
        let weights = match &it.weights {
            Some(weights) if weights.len() != stretches => {
                let message = format!("this rope has {stretches} stretches, but {} `weights`", weights.len());
                let help = "give one number for each stretch from a particle to the next".to_owned();
                self.report.error(place.key("weights").span.clone(), message, Some(help));
                return None;
            }
            Some(weights) => weights.clone(),
            None => vec![1.0; stretches],
        };
        let ends = points.windows(2).map(|pair| [pair[0], pair[1]]);
        let segments: Vec<_> = ends.zip(weights).collect();
        self.add_driven(it, it.length.as_ref(), (place, "length"), |total| Lengths::new(&segments, total).into())
    }

    pub(super) fn add_length_ratio(&mut self, it: &LengthRatio, place: &Node) -> Option<()> {
        let first = self.pair(&it.between, place.key("between"));
        let second = self.pair(&it.of, place.key("of"));
        let ((a, b), (c, d)) = (first?, second?);
        let ratio = it.ratio.unwrap_or_else(|| self.distance(a, b) / self.distance(c, d));
        if !(ratio.is_finite() && ratio > 0.0) {
            let message = "the ratio of these lengths at the start cannot be measured";
            self.report.error(place.span.clone(), message, Some("give `ratio`, or lengths above 0 to both".into()));
            return None;
        }
        let name = self.name_of(it);
        self.builder.constraint(name, Lengths::ratio([a, b], [c, d], ratio));
        Some(())
    }
}
