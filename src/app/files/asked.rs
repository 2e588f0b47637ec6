//! A file that is asked for with the desktop's dialog, on a thread of its own.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use egui::Context;
use rfd::FileDialog;

use super::{Answer, answer};

/// A dialog that may be open.
#[derive(Debug, Default)]
pub(in crate::app) struct Asked {
    dialog: Option<Receiver<Answer<PathBuf>>>,
    has_none: bool,
}

impl Asked {
    /// Asks with a dialog that begins at a file, unless one is open: for one to be written ([`FileDialog::save_file`]) or one
    /// that is there ([`FileDialog::pick_file`]).
    pub(in crate::app) fn ask(
        &mut self,
        mut dialog: FileDialog,
        way: fn(FileDialog) -> Option<PathBuf>,
        near: Option<&Path>,
        ctx: &Context,
    ) {
        if self.dialog.is_some() {
            return;
        }
        if let Some(path) = near {
            if let Some(folder) = path.parent() {
                dialog = dialog.set_directory(folder);
            }
            if let Some(name) = path.file_name() {
                dialog = dialog.set_file_name(name.to_string_lossy());
            }
        }
        let (sender, receiver) = channel();
        let ctx = ctx.clone();
        let spawned = std::thread::Builder::new()
            .name("sootlight-dialog".into())
            .spawn(move || {
                // The window may be gone.
                let _ = sender.send(answer(|| way(dialog)));
                ctx.request_repaint();
            });
        match spawned {
            Ok(_) => self.dialog = Some(receiver),
            Err(_) => self.has_none = true,
        }
    }

    /// What was chosen, once.
    pub(in crate::app) fn answered(&mut self) -> Option<PathBuf> {
        let answer = match self.dialog.as_ref()?.try_recv() {
            Ok(answer) => answer,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Answer::NoDialog,
        };
        self.dialog = None;
        self.has_none = answer == Answer::NoDialog;
        match answer {
            Answer::Chosen(path) => Some(path),
            Answer::Closed | Answer::NoDialog => None,
        }
    }

    /// Whether this desktop turned out to have no dialog.
    pub(in crate::app) fn has_none(&self) -> bool {
        self.has_none
    }
}
