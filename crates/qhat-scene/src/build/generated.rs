//! `[[generate]]`: particles of blocks come after those of `[[particles]]`, their links after `[[constraints]]`.

use super::{Assembly, MOST_PARTICLES};
use crate::model::Generate;
use crate::model::generate::{Common, Link, Plan, RodLink, SpringLink};
use qhat::{Distance, Particle, ParticleId, Spring};
use std::ops::Range;

/// A block whose particles are added and whose links are not.
pub(super) struct Unlinked<'a> {
    link: &'a Link,
    place: Range<usize>,
    ids: Vec<ParticleId>,
    names: Vec<String>,
    pairs: Vec<(usize, usize)>,
}

impl Assembly<'_, '_, '_> {
    /// Adds the particles of all blocks; `None` after an error, because later errors about missing ids would mislead.
    pub(super) fn add_generated<'g>(&mut self, blocks: &'g [Generate]) -> Option<Vec<Unlinked<'g>>> {
        let mut total = self.positions.len() as u64 / self.dimension as u64;
        let mut unlinked = Vec::new();
        for (index, block) in blocks.iter().enumerate() {
            let place = self.tree.key("generate").item(index);
            total = total.saturating_add(block.count());
            if total > MOST_PARTICLES {
                let message =
                    format!("with this block the scene has {total} particles; at most {MOST_PARTICLES} are allowed");
                self.report.error(place.span.clone(), message, Some("ask for fewer particles".into()));
                return None;
            }
            unlinked.extend(self.add_block(block, place.span.clone()));
        }
        (unlinked.len() == blocks.len()).then_some(unlinked)
    }

    fn add_block<'g>(&mut self, block: &'g Generate, place: Range<usize>) -> Option<Unlinked<'g>> {
        let Plan { particles, links } = block.plan();
        let Common { mass, velocity, fixed, link } = block.common();
        if fixed && velocity.is_some_and(|v| v.0.iter().any(|&v| v != 0.0)) {
            let help = "leave out `velocity`, or `fixed`".to_owned();
            self.report.error(place, "fixed particles cannot have a velocity", Some(help));
            return None;
        }
        let mut ids = Vec::with_capacity(particles.len());
        let mut names = Vec::with_capacity(particles.len());
        for (name, at) in particles {
            if !at.iter().all(|x| x.is_finite()) {
                let message =
                    format!("the place of particle {} of this block is not a finite number", self.report.quoted(&name));
                self.report.error(place, message, Some("use smaller numbers".into()));
                return None;
            }
            self.positions.extend(&at);
            self.is_fixed.push(fixed);
            let velocity = velocity.map_or_else(|| vec![0.0; self.dimension], |velocity| velocity.0.clone());
            let added = self.builder.particle(Particle { name: name.clone(), position: at, velocity, mass, fixed });
            if let Err(origin) = self.ids.take(&name, added, place.clone()) {
                let message =
                    format!("this block makes a particle {}, but that id is taken", self.report.quoted(&name));
                let line = self.report.line_of(origin.start);
                let help = format!("the first is in line {line}; use another `prefix`");
                self.report.error(place, message, Some(help));
                return None;
            }
            ids.push(added);
            names.push(name);
        }
        Some(Unlinked { link, place, ids, names, pairs: links })
    }

    /// Adds the links of all blocks.
    pub(super) fn add_links(&mut self, unlinked: &[Unlinked<'_>]) {
        for Unlinked { link, place, ids, names, pairs } in unlinked {
            for &(a, b) in pairs {
                let [a, b] = [a, b].map(|k| (ids[k], names[k].as_str()));
                if self.add_link(link, a, b, place).is_none() {
                    break;
                }
            }
        }
    }

    fn add_link(
        &mut self,
        link: &Link,
        a: (ParticleId, &str),
        b: (ParticleId, &str),
        place: &Range<usize>,
    ) -> Option<()> {
        let length = self.distance(a.0, b.0);
        let (first, second) = (a.0, b.0);
        match link {
            Link::Rod(_) if !(length.is_finite() && length > 0.0) => {
                let [a, b] = [a.1, b.1].map(|name| self.report.quoted(name));
                let message = format!("{a} and {b} of this block start {length} m apart, where no rod can be");
                self.report.error(place.clone(), message, Some("give its particles different places".into()));
                return None;
            }
            Link::Rod(RodLink { form, compliance, damping }) => {
                let name = self.free_name(format!("{}-{}", a.1, b.1));
                let rod = Distance::new(first, second, length).with_compliance(*compliance, *damping);
                self.builder.constraint(name, Distance { form: (*form).into(), ..rod });
            }
            Link::Spring(SpringLink { stiffness, damping }) => {
                let (stiffness, damping) = (*stiffness, *damping);
                self.builder.force(Spring { a: first, b: second, stiffness, damping, rest: length });
            }
            Link::None(_) => {}
        }
        Some(())
    }
}
