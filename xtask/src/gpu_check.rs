//! `cargo xtask gpu-check`: a folder that tries the GPU backend on a machine with a GPU, which needs nothing else of this one.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

use crate::run::{self, step};

/// What begins it there.
const SCRIPT: &str = include_str!("gpu-check.sh");
/// Bytes that it may have in all.
const MOST: u64 = 40_000_000;
/// What of the repository it takes along.
const FOLDERS: [&str; 2] = ["scenes", "puppets"];

/// Puts `target/gpu-check` together around this `kelir`, and says what it needs.
pub(crate) fn make(kelir: &Path) -> Result<()> {
    let folder = run::target_dir().join("gpu-check");
    if folder.exists() {
        std::fs::remove_dir_all(&folder).with_context(|| folder.display().to_string())?;
    }
    for name in FOLDERS {
        copy_files(&run::root().join("stimuli").join(name), &folder.join(name))?;
    }
    let binary = folder.join("kelir");
    let mut strip = Command::new("strip");
    strip.arg("-o").arg(&binary).arg(kelir);
    step("strip", strip)?;
    let bytes = std::fs::read(&binary).with_context(|| binary.display().to_string())?;
    let Some([major, minor]) = newest_glibc(&bytes) else {
        bail!("{}: asks for no version of glibc", kelir.display());
    };
    let glibc = format!("{major}.{minor}");
    std::fs::write(folder.join("run.sh"), SCRIPT.replace("GLIBC", &glibc))?;
    let size = size_of(&folder)?;
    if size > MOST {
        bail!("{}: {size} bytes, at most {MOST}", folder.display());
    }
    eprintln!(
        "── {}: {:.1} MB; on a machine with a GPU (Linux on the same processor architecture, glibc {glibc} or later, a Vulkan driver): sh run.sh",
        folder.display(),
        size as f64 / 1e6
    );
    Ok(())
}

/// The newest version of glibc's symbols that a binary asks for: the dynamic linker reads these names as they stand.
fn newest_glibc(binary: &[u8]) -> Option<[u32; 2]> {
    const NAME: &[u8] = b"\0GLIBC_2.";
    let versions = binary.windows(NAME.len()).enumerate().filter(|(_, window)| *window == NAME);
    let minors = versions.filter_map(|(at, _)| {
        let rest = &binary[at + NAME.len()..];
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
        std::str::from_utf8(&rest[..digits]).ok()?.parse().ok()
    });
    minors.max().map(|minor| [2, minor])
}

/// Copies the files of a folder, not those of folders in it.
fn copy_files(from: &Path, to: &Path) -> Result<()> {
    std::fs::create_dir_all(to).with_context(|| to.display().to_string())?;
    for path in files(from)? {
        std::fs::copy(&path, to.join(path.file_name().unwrap_or_default()))
            .with_context(|| path.display().to_string())?;
    }
    Ok(())
}

fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?;
    Ok(paths.into_iter().filter(|path| path.is_file()).collect())
}

fn size_of(folder: &Path) -> Result<u64> {
    let inner = FOLDERS.map(|name| folder.join(name));
    let mut sum = 0;
    for folder in inner.iter().map(PathBuf::as_path).chain([folder]) {
        for file in files(folder)? {
            sum += file.metadata()?.len();
        }
    }
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_glibc_is_by_number_and_not_by_letter() {
        assert_eq!(newest_glibc(b"x\0GLIBC_2.2.5\0GLIBC_2.34\0GLIBC_2.9\0"), Some([2, 34]));
        assert_eq!(newest_glibc(b"GLIBC_2.99 in a message\0GLIBC_PRIVATE\0GLIBCXX_3.4\0"), None);
    }
}
