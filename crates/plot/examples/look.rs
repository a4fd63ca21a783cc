//! A figure of each kind, on standard output, to look at: `cargo run -p kelir-plot --example look -- log|names`.
#![allow(clippy::print_stdout, reason = "it is run for what it prints")]

use kelir_plot::{Axis, Figure, Point, Rule, Series, svg};

fn main() -> Result<(), kelir_plot::PlotError> {
    let names = std::env::args().nth(1).is_some_and(|kind| kind == "names");
    let point = |x: f64, y: f64, spread: f64| Point {
        x,
        y,
        interval: (spread > 0.0).then_some([y - spread, y + spread]),
        label: None,
    };
    let figure = if names {
        Figure {
            title: "How often the target was chosen".into(),
            x: Axis::names(
                "block",
                ["stills", "photographs", "animations, two pairs"].map(String::from).to_vec(),
            ),
            y: Axis::linear("proportion, 95% interval").within(0.0, 1.0),
            series: vec![Series {
                points: vec![point(0.0, 0.41, 0.12), point(1.0, 0.61, 0.12), point(2.0, 0.21, 0.1)],
                markers: true,
                ..Series::default()
            }],
            rules: vec![Rule::Horizontal(0.5, "chance".into())],
            size: [640, 360],
        }
    } else {
        let series = |name: &str, k: f64, slope: f64| Series {
            name: name.into(),
            points: (0..6)
                .map(|n| 2f64.powi(n) * 1e-3)
                .map(|x| point(x * k, slope * x.powf(-0.5) * 1e-4, 0.0))
                .collect(),
            line: true,
            markers: true,
            ..Series::default()
        };
        Figure {
            title: "Error against time, benchmark, 960×540".into(),
            x: Axis::log10("median time of a frame, s"),
            y: Axis::log10("RMSE over penumbra, full scale = 1"),
            series: vec![
                series("MC", 30.0, 9.0),
                series("points", 10.0, 2.0),
                series("PCSS", 14.0, 2.2),
                series("PA", 1.0, 0.5),
            ],
            rules: vec![Rule::Horizontal(2e-4, "reference's own error".into())],
            size: [760, 460],
        }
    };
    println!("{}", svg(&figure)?);
    Ok(())
}
