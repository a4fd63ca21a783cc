//! What the project needs from the machine, and how to get it.

use std::path::Path;
use std::process::Command;

use anyhow::{Result, bail};

/// Something outside cargo and npm.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// Node.js 20 or newer with npm: builds the web bundle.
    Node,
    /// A C++ compiler: the H.264 encoder of `kelir animate -o FILE.mp4` is built from source.
    Cxx,
    /// A Vulkan driver: the wgpu backend (Mesa's software driver will do).
    Vulkan,
    /// Chromium: the end-to-end tests' browser.
    Chromium,
    /// The sqlite3 shell: the tests read the database with a program that is not ours.
    Sqlite,
}

impl Need {
    fn present(self) -> bool {
        match self {
            Self::Node => node_major().is_some_and(|major| major >= 20) && on_path("npm"),
            Self::Cxx => on_path("c++"),
            Self::Vulkan => ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"]
                .iter()
                .any(|dir| Path::new(dir).read_dir().is_ok_and(|mut files| files.next().is_some())),
            Self::Chromium => Path::new("/usr/bin/chromium").exists(),
            Self::Sqlite => on_path("sqlite3"),
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
        }
    }

    fn why(self) -> &'static str {
        match self {
            Self::Node => "Node.js 20 or newer with npm builds the web pages",
            Self::Cxx => "the H.264 encoder is built with a C++ compiler, c++",
            Self::Vulkan => "the GPU backend needs a Vulkan driver (Mesa's software driver will do)",
            Self::Chromium => "the end-to-end tests click through the pages in Chromium at /usr/bin/chromium",
            Self::Sqlite => "the end-to-end tests read the database with the sqlite3 shell",
        }
    }

    fn by_hand(self) -> &'static str {
        match self {
            Self::Node => "install Node.js 20 or newer from your distribution or https://nodejs.org",
            Self::Cxx => "as root: apt-get install g++",
            Self::Vulkan => "as root: apt-get install mesa-vulkan-drivers",
            Self::Chromium => "as root: apt-get install chromium",
            Self::Sqlite => "as root: apt-get install sqlite3",
        }
    }

    /// Whether a task can go on without it: rendering has the native backend.
    fn optional_for_serving(self) -> bool {
        self == Self::Vulkan
    }
}

/// Installs what is missing where that is possible (Debian or Ubuntu, as root) and says how to do it by hand where not.
///
/// A missing Vulkan driver only stops a task that also needs the browser, that is: the tests.
pub fn ensure(needs: &[Need]) -> Result<()> {
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
        let optional = need.optional_for_serving() && !testing;
        let rank = if optional { "note" } else { "missing" };
        eprintln!("{rank}: {}. Could not install it here; {}.", need.why(), need.by_hand());
        fatal |= !optional;
    }
    if fatal {
        bail!("install what is missing (above), then run this command again");
    }
    Ok(())
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
