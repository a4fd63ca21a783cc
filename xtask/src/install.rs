//! What the project needs from the machine, and how to get it.

use std::path::Path;
use std::process::Command;

use anyhow::{Result, bail};

/// Something outside cargo and npm.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Need {
    /// Node.js 20 or newer with npm: builds the web bundle.
    Node,
    /// A C and a C++ compiler: SQLite and libwebp, meshoptimizer and the H.264 encoder of `kelir animate -o FILE.mp4` are built from source.
    Cxx,
    /// A Vulkan driver: the wgpu backend (Mesa's software driver will do).
    Vulkan,
    /// Chromium: the end-to-end tests' browser.
    Chromium,
    /// The sqlite3 shell: the tests read the database with a program that is not ours.
    Sqlite,
    /// A scanned mesh that the tests simplify: the bunny that Debian has for its benchmark of OpenGL.
    Bunny,
}

impl Need {
    fn present(self) -> bool {
        match self {
            Self::Node => node_major().is_some_and(|major| major >= 20) && on_path("npm"),
            Self::Cxx => on_path("cc") && on_path("c++"),
            Self::Vulkan => ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"]
                .iter()
                .any(|dir| Path::new(dir).read_dir().is_ok_and(|mut files| files.next().is_some())),
            Self::Chromium => Path::new("/usr/bin/chromium").exists(),
            Self::Sqlite => on_path("sqlite3"),
            Self::Bunny => Path::new("/usr/share/glmark2/models/bunny.obj").exists(),
        }
    }

    /// Debian packages that bring it, if Debian 12's are new enough.
    fn packages(self) -> &'static [&'static str] {
        match self {
            Self::Node => &[],
            Self::Cxx => &["g++"],
            Self::Vulkan => &["mesa-vulkan-drivers", "libvulkan1"],
            // Without recommended packages Chromium comes without a font, and a page without text.
            Self::Chromium => &["chromium", "fonts-dejavu-core"],
            Self::Sqlite => &["sqlite3"],
            Self::Bunny => &["glmark2-data"],
        }
    }

    fn why(self) -> &'static str {
        match self {
            Self::Node => "Node.js 20 or newer with npm builds the web pages",
            Self::Cxx => "SQLite and meshoptimizer are built with a C and a C++ compiler, cc and c++",
            Self::Vulkan => "the GPU backend needs a Vulkan driver (Mesa's software driver will do)",
            Self::Chromium => "the end-to-end tests click through the pages in Chromium at /usr/bin/chromium",
            Self::Sqlite => "the end-to-end tests read the database with the sqlite3 shell",
            Self::Bunny => {
                "one test simplifies a scanned mesh, Debian's glmark2-data, and is skipped without it"
            }
        }
    }

    fn by_hand(self) -> &'static str {
        match self {
            Self::Node => "install Node.js 20 or newer from your distribution or https://nodejs.org",
            Self::Cxx => "as root: apt-get install g++",
            Self::Vulkan => "as root: apt-get install mesa-vulkan-drivers",
            Self::Chromium => "as root: apt-get install chromium",
            Self::Sqlite => "as root: apt-get install sqlite3",
            Self::Bunny => "as root: apt-get install glmark2-data",
        }
    }

    /// Whether a task can go on without it: rendering has the native backend, and a test says that it is skipped.
    fn optional(self, testing: bool) -> bool {
        match self {
            Self::Vulkan => !testing,
            Self::Bunny => true,
            _ => false,
        }
    }
}

/// Installs what is missing where that is possible (Debian or Ubuntu, as root) and says how to do it by hand where not.
///
/// A missing Vulkan driver only stops a task that also needs the browser, that is: the tests.
pub(crate) fn ensure(needs: &[Need]) -> Result<()> {
    let testing = needs.contains(&Need::Chromium);
    let missing: Vec<Need> = needs.iter().copied().filter(|need| !need.present()).collect();
    let packages: Vec<&str> = missing.iter().flat_map(|need| need.packages()).copied().collect();
    if !packages.is_empty() && can_apt() {
        eprintln!("── installing {}", packages.join(", "));
        // Failures show up below as what is still missing.
        let _ = apt(&["update", "-qq"]);
        let _ = apt(&[&["install", "-y", "-qq", "--no-install-recommends"][..], &packages].concat());
    }
    let mut fatal = false;
    for need in missing.into_iter().filter(|need| !need.present()) {
        let optional = need.optional(testing);
        let rank = if optional { "note" } else { "missing" };
        eprintln!("{rank}: {}. Could not install it here; {}.", need.why(), need.by_hand());
        fatal |= !optional;
    }
    if fatal {
        bail!("install what is missing (above), then run this command again");
    }
    Ok(())
}

/// Whether this machine has a GPU of its own, not one that its CPU imitates.
pub(crate) fn has_gpu() -> bool {
    has_gpu_below(Path::new("/"))
}

/// NVIDIA's or WSL's own device, or a render node of AMD (PCI vendor 0x1002), Intel or NVIDIA; a virtual machine's display is another's.
fn has_gpu_below(root: &Path) -> bool {
    let cards = std::fs::read_dir(root.join("sys/class/drm")).into_iter().flatten().flatten();
    let mut nodes = cards.filter(|card| card.file_name().to_string_lossy().starts_with("renderD"));
    let vendor = |card: std::fs::DirEntry| std::fs::read_to_string(card.path().join("device/vendor"));
    ["dev/nvidia0", "dev/dxg"].iter().any(|node| root.join(node).exists())
        || nodes.any(|card| {
            vendor(card).is_ok_and(|vendor| ["0x1002", "0x8086", "0x10de"].contains(&vendor.trim()))
        })
}

fn can_apt() -> bool {
    let root = Command::new("id").arg("-u").output().is_ok_and(|out| out.stdout.trim_ascii() == b"0");
    root && on_path("apt-get")
}

fn apt(args: &[&str]) -> std::io::Result<std::process::ExitStatus> {
    Command::new("apt-get")
        .args(args)
        .env("DEBIAN_FRONTEND", "noninteractive")
        .stdout(std::process::Stdio::null())
        .status()
}

fn on_path(program: &str) -> bool {
    std::env::var_os("PATH")
        .is_some_and(|path| std::env::split_paths(&path).any(|dir| dir.join(program).is_file()))
}

fn node_major() -> Option<u32> {
    let out = Command::new("node").arg("--version").output().ok()?;
    let text = String::from_utf8(out.stdout).ok()?;
    text.trim().strip_prefix('v')?.split('.').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    /// A machine's GPUs are told by their render nodes; a display alone or a virtual one is none.
    #[test]
    fn a_real_gpu_is_told_from_a_virtual_one() {
        let machine = tempfile::tempdir().unwrap();
        let card = |name: &str, vendor: &str| {
            let device = machine.path().join("sys/class/drm").join(name).join("device");
            std::fs::create_dir_all(&device).unwrap();
            std::fs::write(device.join("vendor"), vendor).unwrap();
            has_gpu_below(machine.path())
        };
        assert!(!has_gpu_below(machine.path()), "no devices");
        assert!(!card("card0", "0x8086\n"), "a display without a render node");
        assert!(!card("renderD128", "0x1af4\n"), "virtio's");
        assert!(card("renderD129", "0x10de\n"), "NVIDIA's");
    }
}
