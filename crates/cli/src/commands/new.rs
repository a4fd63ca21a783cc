//! `kelir new DIR`: a study of one's own that runs, with a comment at each key.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::bad_input;
use crate::output::print;

/// Arguments of `kelir new`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder to write; it must not exist, or be empty.
    dir: PathBuf,
}

/// What is written, by path below the folder.
const FILES: [(&str, &str); 7] = [
    ("README.md", include_str!("new/README.md")),
    ("studies/my-study.toml", include_str!("new/my-study.toml")),
    ("scenes/hare-near.toml", include_str!("new/hare-near.toml")),
    ("scenes/hare-far.toml", include_str!("new/hare-far.toml")),
    ("puppets/hare.toml", include_str!("new/hare.toml")),
    ("puppets/hare.svg", include_str!("new/hare.svg")),
    ("photos/README.md", include_str!("new/photos.md")),
];

/// Runs the command.
pub(crate) fn run(args: &Args) -> Result<()> {
    let dir = std::path::absolute(&args.dir).with_context(|| args.dir.display().to_string())?;
    let Some(parent) = dir.parent() else {
        return Err(bad_input(format!(
            "DIR = {}: the root of the file system is no folder for a study",
            dir.display()
        )));
    };
    refuse_full(&dir)?;
    fs::create_dir_all(parent).with_context(|| parent.display().to_string())?;
    // Whole or not at all: written beside the folder, then given its name, which an empty folder gives way to.
    let staged = tempfile::Builder::new().prefix(".kelir-new-").tempdir_in(parent);
    let staged = staged.with_context(|| parent.display().to_string())?;
    for (path, text) in FILES {
        write(&staged.path().join(path), text)?;
    }
    fs::rename(staged.path(), &dir).with_context(|| dir.display().to_string())?;
    let shown = args.dir.display();
    let (study, data) = (args.dir.join("studies/my-study.toml"), &args.dir);
    print(&format!(
        "{shown} holds a study that runs. What next:\n\n  \
         kelir study check {}\n  \
         kelir serve --data {}\n\n\
         {shown}/README.md says what is what.",
        word(&study),
        word(data)
    ))
}

/// A path as one word of a shell's command, and none of its options.
fn word(path: &Path) -> String {
    let shown = path.display().to_string();
    let shown = if shown.starts_with('-') { format!("./{shown}") } else { shown };
    let plain = |c: char| c.is_alphanumeric() || "/._-+,:@%".contains(c);
    if shown.chars().all(plain) { shown } else { format!("'{}'", shown.replace('\'', "'\\''")) }
}

/// Errors: something is there already.
fn refuse_full(dir: &Path) -> Result<()> {
    let said = |rule: &str| Err(bad_input(format!("DIR = {}: {rule}", dir.display())));
    match fs::read_dir(dir).map(|mut entries| entries.next().is_some()) {
        Ok(true) => said("is not empty, and nothing in it is touched"),
        Ok(_) if std::env::current_dir().is_ok_and(|here| here == dir) => {
            said("is the folder you are in; go one up and name it from there")
        }
        Ok(_) => Ok(()),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(error) => said(&format!("is no folder that can be written: {error}")),
    }
}

fn write(path: &Path, text: &str) -> Result<()> {
    let folder = path.parent().unwrap_or(path);
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    fs::write(path, text).with_context(|| path.display().to_string())
}
