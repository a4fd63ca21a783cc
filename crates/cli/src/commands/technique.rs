//! `kelir technique`: what draws, and what can be turned on it.

use anyhow::Result;
use kelir_render::Technique;
use kelir_render::techniques::knobs::Knob;
use serde_json::json;

use super::drawing::render_error;
use crate::output::{print, print_json, table};

/// Which technique, and how it is told.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The technique whose knobs are listed; without one, all techniques.
    name: Option<String>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> Result<()> {
    let techniques = match &args.name {
        Some(name) => vec![Technique::parse(name, &Default::default()).map_err(render_error)?],
        None => Technique::all().into(),
    };
    if args.json {
        return print_json(&techniques.iter().map(document).collect::<Vec<_>>());
    }
    let told = |technique: &Technique| match &args.name {
        Some(_) => knobs(technique),
        None => format!("{:<8} {}\n", technique.name(), technique.about()),
    };
    print(&techniques.iter().map(told).collect::<String>())
}

/// A line a knob: its name, what it stands at, what it may be, what it does.
fn knobs(technique: &Technique) -> String {
    let stand = technique.stand();
    let row = |knob: &Knob| {
        let stands = stand.get(knob.name).map_or_else(|| "–".to_owned(), ToString::to_string);
        vec![
            knob.name.to_owned(),
            knob.unit.to_owned(),
            stands,
            knob.range.to_string(),
            knob.about.to_owned(),
        ]
    };
    let rows: Vec<_> = technique.knobs().iter().map(row).collect();
    let table = table(&["knob", "unit", "default", "must be", "what it does"], &rows);
    format!("{}: {}\n\n{table}", technique.name(), technique.about())
}

fn document(technique: &Technique) -> serde_json::Value {
    let stand = technique.stand();
    let knob = |knob: &Knob| {
        json!({
            "name": knob.name, "unit": knob.unit, "rule": knob.range.to_string(), "default": stand.get(knob.name), "about": knob.about,
        })
    };
    let knobs: Vec<_> = technique.knobs().iter().map(knob).collect();
    json!({ "technique": technique.name(), "about": technique.about(), "knobs": knobs })
}
