//! Contacts and breakable constraints of a System, found once.

use crate::constraint::{Holds, NamedConstraint};
use std::ops::Range;

/// A contact: a row that opens and closes, with its rows of friction.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Contact {
    /// The index of its constraint.
    pub(crate) constraint: usize,
    pub(crate) normal: usize,
    /// Rows of friction: none without friction, one in the plane, two in space.
    pub(crate) tangents: Range<usize>,
    /// e, the part of the closing speed that an impact gives back.
    pub(crate) restitution: f64,
    /// μ, the coefficient of friction.
    pub(crate) friction: f64,
    /// Its index among the breakable constraints, if it is breakable.
    pub(crate) breakable: Option<usize>,
}

/// A constraint that breaks under tension.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Breakable {
    /// The index of its constraint.
    pub(crate) constraint: usize,
    pub(crate) rows: Range<usize>,
    /// The tension at which it breaks [N].
    pub(crate) limit: f64,
    /// The impulse at which it breaks [N·s].
    pub(crate) impulse_limit: f64,
}

/// The contacts and the breakable constraints of a system.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Contacts {
    pub(crate) list: Vec<Contact>,
    pub(crate) breakables: Vec<Breakable>,
}

impl Contacts {
    pub(crate) fn new(constraints: &[NamedConstraint], dimension: usize) -> Self {
        let mut contacts = Contacts::default();
        for (place, named) in constraints.iter().enumerate() {
            let NamedConstraint { constraint, first_row, .. } = named;
            let limits = [constraint.breaks_at(), constraint.breaks_at_impulse()];
            let may_break = limits.iter().any(Option::is_some);
            let breakable = may_break.then_some(contacts.breakables.len());
            for rows in constraint.contacts(dimension).into_iter().flatten() {
                let normal = first_row + rows.normal;
                let tangents = first_row + rows.tangents.start..first_row + rows.tangents.end;
                let (restitution, friction) = (rows.restitution, rows.friction);
                contacts.list.push(Contact { constraint: place, normal, tangents, restitution, friction, breakable });
            }
            if may_break {
                let rows = named.rows(dimension);
                let [limit, impulse_limit] = limits.map(|limit| limit.unwrap_or(f64::INFINITY));
                contacts.breakables.push(Breakable { constraint: place, rows, limit, impulse_limit });
            }
        }
        contacts
    }

    /// Takes the numbers of the constraints anew; the rows are the same.
    pub(crate) fn renew(&mut self, constraints: &[NamedConstraint], dimension: usize) {
        for contact in &mut self.list {
            let NamedConstraint { constraint, first_row, .. } = &constraints[contact.constraint];
            for rows in constraint.contacts(dimension).into_iter().flatten() {
                if first_row + rows.normal == contact.normal {
                    (contact.restitution, contact.friction) = (rows.restitution, rows.friction);
                }
            }
        }
        for breakable in &mut self.breakables {
            let constraint = &constraints[breakable.constraint].constraint;
            breakable.limit = constraint.breaks_at().unwrap_or(f64::INFINITY);
            breakable.impulse_limit = constraint.breaks_at_impulse().unwrap_or(f64::INFINITY);
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty() && self.breakables.is_empty()
    }
}
