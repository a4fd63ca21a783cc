//! Shaders as naga reads them, and what of them stands in Rust too.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use std::collections::BTreeMap;

/// Every shader is valid WGSL by naga's own validator; one with an error is not (negative control).
#[test]
fn shaders_are_valid() {
    use wgpu::naga::{front::wgsl, valid};
    let check = |text: &str| -> Result<(), String> {
        let module = wgsl::parse_str(text).map_err(|e| e.to_string())?;
        valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::empty())
            .validate(&module)
            .map(|_| ())
            .map_err(|e| format!("{e:?}"))
    };
    for (name, text) in shaders() {
        check(text).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(check(&text.replace("@builtin(", "@builtin(no_")).is_err(), "{name}");
    }
}

/// All shaders of the crate, found in the source tree so that a new one can't be forgotten.
fn shaders() -> Vec<(String, &'static str)> {
    fn find(folder: &std::path::Path, found: &mut Vec<(String, &'static str)>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                find(&path, found);
            } else if path.extension().is_some_and(|e| e == "wgsl") {
                let text = std::fs::read_to_string(&path).unwrap();
                found.push((path.file_name().unwrap().to_string_lossy().into(), text.leak()));
            }
        }
    }
    let mut found = Vec::new();
    find(std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src")), &mut found);
    assert!(found.len() >= 5);
    found
}

/// Constants of a WGSL text by name, and the size of its workgroups as `workgroup_size` where it has compute passes.
pub(crate) fn wgsl_constants(text: &str) -> BTreeMap<String, u32> {
    use wgpu::naga::{Expression, Literal, ShaderStage};
    let module = wgpu::naga::front::wgsl::parse_str(text).unwrap();
    let mut found = BTreeMap::new();
    for (_, constant) in module.constants.iter() {
        let Expression::Literal(Literal::U32(value)) = module.global_expressions[constant.init] else {
            panic!("{:?} is no u32", constant.name)
        };
        found.insert(constant.name.clone().unwrap(), value);
    }
    for pass in module.entry_points.iter().filter(|pass| pass.stage == ShaderStage::Compute) {
        let [size, 1, 1] = pass.workgroup_size else {
            panic!("{} has workgroups of two dimensions", pass.name)
        };
        let known = found.insert("workgroup_size".to_owned(), size);
        assert!(known.is_none_or(|known| known == size), "{}", pass.name);
    }
    found
}

/// Asserts that a WGSL text has these constants and no others, with the values that Rust has.
macro_rules! same_constants {
    ($wgsl:expr, { $($name:literal: $value:expr),* $(,)? }) => {{
        let ours = [$(($name.to_owned(), u32::try_from($value).unwrap())),*].into();
        assert_eq!($crate::shaders::wgsl_constants($wgsl), ours);
    }};
}
pub(crate) use same_constants;

/// A constant that differs, is missing or has no twin is seen (negative control); a shift is worked out.
#[test]
fn constants_are_read() {
    let wgsl = "const A = 64u;\nconst LOWEST = 114u << 23u;\n@compute @workgroup_size(32)\nfn f() {}";
    same_constants!(wgsl, { "A": 64, "LOWEST": 114u32 << 23, "workgroup_size": 32 });
    let ours = |a: u32| BTreeMap::from([("A".to_owned(), a), ("workgroup_size".to_owned(), 32)]);
    assert_ne!(wgsl_constants(wgsl), ours(64));
    let wgsl = "const A = 64u;\n@compute @workgroup_size(32)\nfn f() {}";
    assert_eq!(wgsl_constants(wgsl), ours(64));
    assert_ne!(wgsl_constants(wgsl), ours(63));
}

/// Every shader is asked about: a new one needs a test with `same_constants` beside its technique's others, then its name here.
#[test]
fn no_shader_is_left_out() {
    let mut names: Vec<String> = shaders().into_iter().map(|(name, _)| name).collect();
    names.sort();
    assert_eq!(
        names,
        [
            "pcss.wgsl",
            "rows.wgsl",
            "shade.wgsl",
            "table.wgsl",
            "tilted.wgsl",
            "trace.wgsl",
            "visibility.wgsl"
        ]
    );
}

/// (offset, name) of a WGSL struct's members, and its size.
pub(crate) fn wgsl_layout(text: &str, name: &str) -> (Vec<(usize, String)>, usize) {
    let module = wgpu::naga::front::wgsl::parse_str(text).unwrap();
    let (_, found) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).unwrap();
    let wgpu::naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
    let members = members.iter().map(|m| (m.offset as usize, m.name.clone().unwrap_or_default())).collect();
    (members, *span as usize)
}

/// Asserts that a Rust struct has the WGSL struct's fields at the same offsets, in order, and the same size.
macro_rules! same_layout {
    ($wgsl:expr, $name:literal, $rust:ty { $($field:ident),* $(,)? }) => {{
        let (members, size) = $crate::shaders::wgsl_layout($wgsl, $name);
        let ours = vec![$((std::mem::offset_of!($rust, $field), stringify!($field).to_string())),*];
        assert_eq!(members, ours, "{}", $name);
        assert_eq!(size, size_of::<$rust>(), "{}", $name);
    }};
}
pub(crate) use same_layout;
