//! The files that a scene names, read once each.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::rc::Rc;

use kelir_reader::{Node, Reading};

use crate::assets::{Assets, resolve};

/// Reads and remembers files of one reading.
pub(crate) struct Loader<'a> {
    assets: &'a dyn Assets,
    /// What messages put before a path from the root.
    prefix: String,
    files: RefCell<BTreeMap<String, Rc<[u8]>>>,
    pub reading: &'a Reading,
}

impl<'a> Loader<'a> {
    /// `label` is how the caller calls the scene file, `name` its path from the root.
    pub(crate) fn new(assets: &'a dyn Assets, label: &str, name: &str, reading: &'a Reading) -> Self {
        let prefix = label.strip_suffix(name).unwrap_or("").to_owned();
        Self { assets, prefix, files: RefCell::default(), reading }
    }

    /// How messages call a file.
    pub(crate) fn label(&self, path: &str) -> String {
        format!("{}{path}", self.prefix)
    }

    /// The file that `node` names, relative to the file `from`: its path from the root and its bytes, at most `most`.
    pub(crate) fn read(&self, from: &str, node: &Node, most: usize) -> Option<(String, Rc<[u8]>)> {
        let path = match resolve(from, node.string()?) {
            Ok(path) => path,
            Err(rule) => return node.refuse(rule),
        };
        let known = self.files.borrow().get(&path).cloned();
        let bytes: Rc<[u8]> = match known {
            Some(bytes) => bytes,
            None => match self.assets.read(&path) {
                Ok(bytes) => bytes.into(),
                Err(e) if e.kind() == ErrorKind::NotFound => {
                    return node.refuse(format!("there is no file {}", self.label(&path)));
                }
                Err(e) => return node.refuse(format!("{} can't be read: {e}", self.label(&path))),
            },
        };
        if bytes.len() > most {
            return node.refuse(format!("{} has more than {most} bytes", self.label(&path)));
        }
        self.files.borrow_mut().insert(path.clone(), bytes.clone());
        Some((path, bytes))
    }

    /// A file by its path from the root, at most `most` bytes. Errors: why it can't be had.
    pub(crate) fn bytes(&self, path: &str, most: usize) -> Result<Rc<[u8]>, String> {
        let known = self.files.borrow().get(path).cloned();
        let bytes: Rc<[u8]> = match known {
            Some(bytes) => bytes,
            None => self.assets.read(path).map_err(|e| format!("{}: {e}", self.label(path)))?.into(),
        };
        if bytes.len() > most {
            return Err(format!("{} has more than {most} bytes", self.label(path)));
        }
        self.files.borrow_mut().insert(path.to_owned(), bytes.clone());
        Ok(bytes)
    }

    /// Every file that was read, by its path from the root.
    pub(crate) fn files(self) -> BTreeMap<String, Rc<[u8]>> {
        self.files.into_inner()
    }
}
