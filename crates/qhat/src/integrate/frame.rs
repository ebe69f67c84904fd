//! Frame: the context of one call of an integrator.

use super::Workspace;
use crate::settings::Settings;
use crate::system::System;

/// One step of a fixed-step integrator, or one frame of an adaptive one: the system, how it is integrated, in which
/// arrays and over what time. The state, which changes, is not part of it.
pub(crate) struct Frame<'a> {
    pub(crate) system: &'a System,
    pub(crate) settings: &'a Settings,
    pub(crate) workspace: &'a mut Workspace,
    /// The length of the frame [s].
    pub(crate) length: f64,
}

impl Frame<'_> {
    /// The same over another length [s].
    pub(crate) fn over(&mut self, length: f64) -> Frame<'_> {
        Frame { system: self.system, settings: self.settings, workspace: self.workspace, length }
    }

    /// Factorizations of A in the workspace so far.
    pub(crate) fn factorizations(&self) -> usize {
        self.workspace.equation.solver.factorizations
    }
}
