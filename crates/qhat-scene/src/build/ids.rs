//! The ids of the particles: the known ids, their places in the text, and suggestions for an unknown id.

use crate::suggest::nearest;
use qhat::ParticleId;
use std::collections::BTreeMap;
use std::ops::Range;

/// The ids of the particles in alphabetical order, so that the same scene gives the same suggestions.
#[derive(Default)]
pub(super) struct Ids {
    known: BTreeMap<String, (ParticleId, Range<usize>)>,
}

impl Ids {
    /// Takes an id.
    ///
    /// # Errors
    /// The place of the first particle with this id.
    pub(super) fn take(&mut self, id: &str, particle: ParticleId, origin: Range<usize>) -> Result<(), Range<usize>> {
        if let Some((_, first)) = self.known.get(id) {
            return Err(first.clone());
        }
        self.known.insert(id.to_owned(), (particle, origin));
        Ok(())
    }

    pub(super) fn find(&self, id: &str) -> Option<ParticleId> {
        self.known.get(id).map(|(particle, _)| *particle)
    }

    /// The place of an id in the text.
    pub(super) fn origin(&self, id: &str) -> Option<Range<usize>> {
        self.known.get(id).map(|(_, origin)| origin.clone())
    }

    /// The help for an id that does not exist.
    pub(super) fn help(&self, id: &str) -> String {
        if let Some((first, last)) = self.numbered_like(id) {
            return format!("they go from `{first}` to `{last}`");
        }
        if let Some(name) = nearest(id, self.alike(id)) {
            return format!("did you mean `{name}`?");
        }
        const SHOWN: usize = 8;
        let shown: Vec<String> = self.known.keys().take(SHOWN).map(|known| format!("`{known}`")).collect();
        let rest = if self.known.len() > SHOWN { ", …" } else { "" };
        format!("the particles are {}{rest}", shown.join(", "))
    }

    /// An id in a text that expressions cannot read as a name, because of its characters.
    pub(super) fn without_name<'a>(&'a self, text: &str) -> Option<&'a str> {
        let is_name =
            |id: &str| id.chars().all(|letter| letter.is_alphabetic() || letter.is_ascii_digit() || letter == '_');
        self.known.keys().map(String::as_str).find(|id| !is_name(id) && text.contains(id))
    }

    /// All ids, those with the same first letter first: the search for a suggestion reads only the first ids.
    pub(super) fn alike(&self, id: &str) -> impl Iterator<Item = &str> {
        let beginning: String = id.chars().take(1).collect();
        let from = self.known.range(beginning.clone()..).map(|(known, _)| known);
        from.take_while(move |known| known.starts_with(&beginning)).chain(self.known.keys()).map(String::as_str)
    }

    /// The first and the last of several ids that differ from this one in their number only.
    fn numbered_like(&self, id: &str) -> Option<(String, String)> {
        let stem = id.trim_end_matches(|letter: char| letter.is_ascii_digit());
        if stem.len() == id.len() {
            return None;
        }
        let alike = self.known.range(stem.to_owned()..).map_while(|(known, _)| known.strip_prefix(stem));
        let mut numbers: Vec<u64> = alike.filter_map(|rest| rest.parse().ok()).collect();
        numbers.sort_unstable();
        match numbers.as_slice() {
            [first, .., last] => Some((format!("{stem}{first}"), format!("{stem}{last}"))),
            _ => None,
        }
    }
}
