//! `kind = "curve"` of `[[constraints]]`: wires by expressions and by points.

use super::Assembly;
use crate::model::Parameters;
use crate::model::kinds::Curve;
use crate::tree::Node;
use qhat::Purpose;

impl Assembly<'_, '_, '_> {
    /// `Some` if no key is there that the way in which a curve is given does not know.
    fn fits_curve(&mut self, it: &Curve, place: &Node) -> Option<()> {
        let (keys, given, other) = match (&it.path, &it.points) {
            (Some(_), None) => (&["radius", "closed"][..], "path", "points"),
            (None, Some(_)) => (&["range"][..], "points", "path"),
            _ => return Some(()),
        };
        let Some(key) = keys.iter().find(|key| place.get(key).is_some()) else { return Some(()) };
        let message = format!("`{key}` goes with `{other}`, but this curve is given by `{given}`");
        self.report.error(place.key(key).span.clone(), message, Some(format!("leave out `{key}`")));
        None
    }

    pub(super) fn add_curve(&mut self, it: &Curve, place: &Node) -> Option<()> {
        let particle = self.particle(&it.particle, place.key("particle"))?;
        self.fits_curve(it, place)?;
        let curve = match (&it.path, &it.points) {
            (Some(path), None) => {
                let Some([from, to]) = it.range else {
                    if place.get("range").is_some() {
                        return None;
                    }
                    let help = "add `range`, the values of s at its two ends, as in `range = [0.0, 1.0]`".to_owned();
                    self.report.error(place.span.clone(), "a curve by `path` needs a `range`", Some(help));
                    return None;
                };
                let list = place.key("path");
                let components = path.iter().enumerate();
                let components: Vec<_> = components
                    .map(|(i, text)| self.expression(text, Purpose::Curve, &Parameters::new(), list.item(i)))
                    .collect();
                qhat::Curve::parametric(components.into_iter().collect::<Option<_>>()?, from, to)
            }
            (None, Some(points)) => {
                let points: Vec<_> = points.iter().map(|point| point.padded()).collect();
                match it.radius {
                    Some(radius) => qhat::Curve::polyline(&points, radius, it.closed),
                    None => qhat::Curve::through(&points, it.closed),
                }
            }
            (given, _) => {
                self.needs_one(place, "curve", ["path", "points"], given.is_some());
                return None;
            }
        };
        match curve {
            Ok(curve) => {
                self.add_named(it.id.as_ref(), format!("curve({})", it.particle.0), qhat::OnCurve { particle, curve });
                Some(())
            }
            Err(reason) => {
                let span = if it.radius.is_some() { &place.key("points").span } else { &place.span };
                self.report.error(span.clone(), reason.to_string(), None);
                None
            }
        }
    }
}
