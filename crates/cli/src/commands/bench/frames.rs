//! `kelir bench frames`.

use std::path::Path;

use anyhow::Result;
use kelir_render::bench::{Case, frames};

use super::write_json;
use crate::bad_input;
use crate::commands::drawing::{Drawing, render_error};
use crate::output::{print, table};

/// Prints the frames a second of the four cases, and what bounds each.
pub fn run(drawing: &Drawing, count: usize, json: Option<&Path>) -> Result<()> {
    if count == 0 {
        return Err(bad_input("frames = 0: at least one frame is drawn"));
    }
    let mut scene = drawing.load()?;
    let view = drawing.view(&scene.still());
    let cases = [Case::Slid, Case::Posed, Case::LampMoved, Case::NothingSkipped];
    let report = frames(&mut scene, &drawing.technique(), drawing.backend, &view, count, &cases)
        .map_err(render_error)?;
    let [width, height] = report.size;
    print(&format!("{width}x{height}, {} frames a case, {}\n", report.frames, report.adapter))?;
    let rows: Vec<Vec<String>> = report
        .cases
        .iter()
        .map(|case| {
            let name = match case.case {
                Case::Slid => "puppet slid",
                Case::Posed => "puppet posed",
                Case::LampMoved => "lamp moved",
                Case::NothingSkipped => "nothing skipped",
            };
            let steps: Vec<String> =
                case.steps_ms.iter().map(|(step, ms)| format!("{step} {ms:.2}")).collect();
            vec![
                name.to_owned(),
                format!("{:.1}", case.fps),
                format!("{:.3}", case.median_ms),
                format!("{:.3}", case.p99_ms),
                format!("{:.3}", case.floor_ms),
                format!("{:.1}", case.ratio),
                steps.join(", "),
            ]
        })
        .collect();
    print(&table(
        &["case", "frames/s", "median ms", "p99 ms", "fill ms", "median/fill", "steps, ms"],
        &rows,
    ))?;
    write_json(json, &report)
}
