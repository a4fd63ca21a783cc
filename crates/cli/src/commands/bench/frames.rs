//! `kelir bench frames`.

use anyhow::Result;
use kelir_render::bench::{self, Case, CaseReport, FramesReport, Saving, Scaled};
use kelir_render::{Backend, Technique};

use crate::bad_input;
use crate::commands::drawing::{Drawing, render_error};
use crate::output::{Figures, table};

/// Prints the frames a second of the four cases and what bounds each, what each skip saves, and on request how all of it scales.
pub(super) fn run(drawing: &Drawing, count: usize, with_scaling: bool, figures: &Figures) -> Result<()> {
    if count == 0 {
        return Err(bad_input("frames = 0: at least one frame is drawn"));
    }
    let scene = drawing.load()?;
    let view = drawing.view(&scene.still())?;
    let technique = drawing.technique()?;
    let report =
        bench::frames(&scene, &technique, drawing.backend, &view, count, &Case::ALL).map_err(render_error)?;
    figures.say(&cases(&report))?;
    if scene.timeline().is_none() {
        figures.say("\nThe scene has no [timeline]: no puppet is posed.")?;
    }
    let fewer = (count / 4).clamp(5, count.max(5));
    let savings = match (&technique, drawing.backend) {
        (Technique::Pa(knobs), Backend::Cpu | Backend::Auto)
            if view.skip && report.adapter.starts_with("native") =>
        {
            bench::savings(&scene, knobs, &view, fewer).map_err(render_error)?
        }
        _ => Vec::new(),
    };
    if !savings.is_empty() {
        figures.say(
            "\nWhat each skip saves of a frame with a slid puppet: all skips, and all but this one, in turn\n",
        )?;
        let header = ["skipped", "how often", "with ms", "without ms", "saves ms"];
        figures.say(&table(&header, &savings.iter().map(saving_line).collect::<Vec<_>>()))?;
        let [build, copy] = bench::table(4096, fewer);
        figures.say(&format!(
            "\nA table of 4096² texels takes {build:.2} ms, copying them to as wide entries {copy:.2} ms: {:.2} x its speed",
            copy / build
        ))?;
    }
    let scaled = if with_scaling {
        bench::scaling(&scene, &technique, drawing.backend, &view, fewer).map_err(render_error)?
    } else {
        Vec::new()
    };
    if with_scaling {
        figures.say("\nA slid puppet with one thing changed\n")?;
        figures.say(&table(&["what", "value", "median ms", "frames/s"], &scaled_lines(&scaled)))?;
    }
    figures.give(&serde_json::json!({ "frames": report, "savings": savings, "scaling": scaled }))
}

/// What drew, and a line a case.
pub(super) fn cases(report: &FramesReport) -> String {
    let [width, height] = report.size;
    let header =
        ["case", "frames/s", "median ms", "p99 ms", "fill ms", "median/fill", "bound by", "steps, ms"];
    let lines: Vec<_> = report.cases.iter().map(case_line).collect();
    let (frames, adapter) = (report.frames, &report.adapter);
    format!("{width}x{height}, {frames} frames a case, {adapter}\n\n{}", table(&header, &lines))
}

fn case_line(case: &CaseReport) -> Vec<String> {
    let name = match case.case {
        Case::Slid => "puppet slid",
        Case::Posed => "puppet posed",
        Case::LampMoved => "lamp moved",
        Case::NothingSkipped => "nothing skipped",
    };
    let steps: Vec<String> = case.steps_ms.iter().map(|(step, ms)| format!("{step} {ms:.2}")).collect();
    vec![
        name.to_owned(),
        format!("{:.1}", case.fps),
        format!("{:.3}", case.median_ms),
        format!("{:.3}", case.p99_ms),
        format!("{:.3}", case.floor_ms),
        format!("{:.1}", case.ratio),
        case.bound.clone(),
        steps.join(", "),
    ]
}

fn saving_line(saving: &Saving) -> Vec<String> {
    let (with, without) = (saving.with_ms, saving.without_ms);
    if saving.count == 0 {
        let none = || "–".to_owned();
        return vec![saving.skip.to_owned(), "0".into(), format!("{with:.3}"), none(), none()];
    }
    let numbers = [with, without, without - with].map(|ms| format!("{ms:.3}"));
    [vec![saving.skip.to_owned(), saving.count.to_string()], numbers.to_vec()].concat()
}

fn scaled_lines(scaled: &[Scaled]) -> Vec<Vec<String>> {
    let line = |(k, row): (usize, &Scaled)| {
        let same = k > 0 && scaled[k - 1].what == row.what;
        vec![
            if same { String::new() } else { row.what.to_owned() },
            row.value.clone(),
            format!("{:.3}", row.median_ms),
            format!("{:.1}", row.fps),
        ]
    };
    scaled.iter().enumerate().map(line).collect()
}
