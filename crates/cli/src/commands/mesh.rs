//! `kelir mesh`: mesh files checked and brought in, levels of detail made and measured.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Result;
use clap::ValueEnum;
use kelir_mesh::{
    Attributes, Format, Level, Made, Measured, Model, OneWay, Report, SAMPLES, Unit, check_model, ladder,
    levels, levels_key, read, repair_model, sha256, write_glb,
};
use kelir_render::file;
use kelir_render::folder::Folder;
use kelir_study::{Problem, Problems};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::checked::Checked;
use crate::bad_input;
use crate::output::{print, print_json, table};

/// Bytes of a mesh file, and of each file that it names.
const MOST_BYTES: u64 = 1 << 30;
/// What says of a folder of levels that it is whole, and of what.
const INDEX: &str = "levels.json";
/// The points that distances are measured from are the same ones every time.
const SEED: u64 = 1;

/// Subcommands of `kelir mesh`.
#[derive(clap::Subcommand)]
pub(crate) enum Command {
    /// Look at mesh files: what is wrong with them, each with its count.
    Check {
        /// Mesh files (.obj, .ply, .gltf or .glb), or names of models that ship.
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Print one JSON document.
        #[arg(long)]
        json: bool,
    },
    /// Bring a mesh file in: it becomes a binary glTF file (.glb) in metres.
    Import {
        #[command(flatten)]
        source: Source,
        /// Weld vertices, drop faces without area or twice there and what is not used, wind faces alike and outwards; say what was done.
        #[arg(long)]
        repair: bool,
        /// File to write: .glb.
        #[arg(short, long)]
        output: PathBuf,
    },
    /// List the models that ship: any of them may be given by its name in place of a file.
    List {
        /// Print one JSON document.
        #[arg(long)]
        json: bool,
    },
    /// Make levels of detail: the same surface with fewer triangles, and how far each is from the whole.
    Lod(LodArgs),
}

/// A mesh file and its unit.
#[derive(clap::Args)]
pub(crate) struct Source {
    /// Mesh file (.obj, .ply, .gltf or .glb), or the name of a model that ships.
    file: PathBuf,
    /// What its numbers are in; glTF says metres.
    #[arg(long, value_enum, default_value = "m")]
    unit: UnitName,
}

#[derive(Clone, Copy, ValueEnum)]
enum UnitName {
    M,
    Cm,
    Mm,
    In,
}

impl From<UnitName> for Unit {
    fn from(name: UnitName) -> Unit {
        match name {
            UnitName::M => Unit::Metre,
            UnitName::Cm => Unit::Centimetre,
            UnitName::Mm => Unit::Millimetre,
            UnitName::In => Unit::Inch,
        }
    }
}

/// Arguments of `kelir mesh lod`.
#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("levels").required(true).args(["triangles", "steps"])))]
pub(crate) struct LodArgs {
    #[command(flatten)]
    source: Source,
    /// Triangles of each level, from the finest to the coarsest: 5000,1000,300.
    #[arg(long, value_delimiter = ',')]
    triangles: Vec<usize>,
    /// In place of them, so many levels, each the same share of the one before it.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1000))]
    steps: Option<u32>,
    /// Triangles of the coarsest of these.
    #[arg(long, default_value = "100", conflicts_with = "triangles")]
    min: usize,
    /// Let the shading normals guide the simplification, too: they stay truer, the surface a little less so.
    #[arg(long)]
    normals: bool,
    /// Folder to write: level-NN-TRIANGLES.glb and levels.json. What it holds of the same mesh and settings is not made again.
    #[arg(short, long)]
    output: PathBuf,
    /// Print levels.json in place of the table.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(crate) fn run(command: Command) -> Result<()> {
    match command {
        Command::Check { files, json } => check(&files, json),
        Command::Import { source, repair, output } => import(&source, repair, &output),
        Command::List { json } => list(json),
        Command::Lod(args) => lod(&args),
    }
}

/// A model that ships.
#[derive(Serialize)]
struct Shipped {
    name: &'static str,
    shows: &'static str,
    triangles: usize,
    /// Width, height and depth, metres.
    size_m: [f32; 3],
    /// Names of its nodes.
    nodes: Vec<String>,
    /// The hash of all of it, at rest.
    sha256: String,
}

impl Shipped {
    fn of(made: Made) -> Shipped {
        let model = made.make();
        let mesh = model.merged(&model.rest());
        let size = mesh.bounds().map(|bounds| [0, 1, 2].map(|k| bounds.max[k] - bounds.min[k]));
        Shipped {
            name: made.name(),
            shows: made.shows(),
            triangles: mesh.triangles.len(),
            size_m: size.unwrap_or_default(),
            nodes: model.nodes.into_iter().map(|node| node.name).filter(|name| !name.is_empty()).collect(),
            sha256: mesh.hash(),
        }
    }
}

fn list(json: bool) -> Result<()> {
    let models: Vec<Shipped> = Made::ALL.into_iter().map(Shipped::of).collect();
    if json {
        return print_json(&models);
    }
    let line = |model: &Shipped| {
        let [x, y, z] = model.size_m;
        let size = format!("{x:.2} × {y:.2} × {z:.2} m");
        vec![model.name.to_owned(), model.triangles.to_string(), size, model.shows.to_owned()]
    };
    let lines: Vec<_> = models.iter().map(line).collect();
    print(&table(&["name", "triangles", "size", "shows"], &lines))
}

fn check(files: &[PathBuf], json: bool) -> Result<()> {
    let mut checked = Checked::new(json);
    for path in files {
        match open(path, Unit::Metre) {
            Err(problem) => checked.wrong(path, &Problems::new(vec![problem])),
            Ok(model) => {
                let report = check_model(&model);
                match faults(path, &report) {
                    Some(problems) => checked.bad(path, json!(report), &problems),
                    None => checked.good(path, &described(&report), json!(report), &[])?,
                }
            }
        }
    }
    checked.finish()
}

fn faults(path: &Path, report: &Report) -> Option<Problems> {
    let problem = |rule| Problem::new(path.display().to_string(), "", None, rule);
    let problems: Vec<Problem> = report.faults().into_iter().map(problem).collect();
    (!problems.is_empty()).then(|| Problems::new(problems))
}

fn described(report: &Report) -> String {
    let Report { vertices, triangles, boundary_edges, parts, euler, .. } = report;
    let parts = if *parts == 1 { "1 part".to_owned() } else { format!("{parts} parts") };
    let closed =
        if report.closed { "closed".to_owned() } else { format!("open along {boundary_edges} edges") };
    format!("{vertices} vertices, {triangles} triangles, {parts}, {closed}, Euler number {euler}")
}

fn import(source: &Source, repair: bool, output: &Path) -> Result<()> {
    if Format::of(&output.to_string_lossy()) != Some(Format::Glb) {
        return Err(bad_input(format!("output = {}: the name ends in .glb", output.display())));
    }
    file::try_writing(output)?;
    let mut model = open(&source.file, source.unit.into()).map_err(bad_input)?;
    let repaired = if repair { repair_model(&mut model).list() } else { Vec::new() };
    let report = check_model(&model);
    // What can't be drawn is never brought in; what can, as it is only where that was asked for.
    if let Some(problems) = faults(&source.file, &report).filter(|_| !repair || !report.is_drawable()) {
        let hint = if repair {
            "nothing is written"
        } else {
            "nothing is written; --repair mends what needs no guess"
        };
        return Err(bad_input(format!("{problems}\n{hint}")));
    }
    file::write_atomic(output, &write_glb(&model))?;
    print(&format!("{}: {}", output.display(), described(&report)))?;
    repaired.iter().try_for_each(|done| print(&format!("  {done}")))?;
    report.faults().iter().try_for_each(|left| print(&format!("  left as they are: {left}")))
}

/// Reads a mesh file and those beside it that it names, or makes the model of a name.
fn open(path: &Path, unit: Unit) -> Result<Model, Problem> {
    let shown = path.display().to_string();
    if let Some(made) = Made::of(&shown).filter(|_| !path.exists()) {
        return match unit {
            Unit::Metre => Ok(made.make()),
            _ => Err(Problem::new(
                shown,
                "unit",
                Some(unit.name().to_owned()),
                "a model that ships is in metres",
            )),
        };
    }
    let whole = |rule: String| Problem::new(&shown, "", None, rule);
    let Some(format) = Format::of(&path.to_string_lossy()) else {
        return Err(whole("the name of a mesh file ends in .obj, .ply, .gltf or .glb; kelir mesh list says which models ship".to_owned()));
    };
    let bytes = bytes_of(path).map_err(whole)?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    read(&bytes, format, unit, &mut |name| bytes_of(&folder.join(name)))
        .map_err(|fault| Problem::new(&shown, fault.place, fault.value, fault.rule))
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(|error| error.to_string())?;
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(format!("a mesh file has at most {} MiB", MOST_BYTES >> 20));
    }
    Ok(bytes)
}

/// Levels of one mesh.
#[derive(Serialize, Deserialize)]
struct Levels {
    /// Hash of the mesh and all settings.
    key: String,
    /// The whole one.
    mesh_sha256: String,
    triangles: usize,
    /// The diagonal of its box: what shares are of.
    diagonal_m: f64,
    /// What guided the simplification: `positions`, or `positions and normals`.
    guided_by: String,
    /// Points of each surface that distances were measured from, and their seed.
    samples: usize,
    seed: u64,
    levels: Vec<Row>,
}

/// One level.
#[derive(Serialize, Deserialize)]
struct Row {
    file: String,
    sha256: String,
    /// Triangles asked for, and those there are.
    target: usize,
    triangles: usize,
    vertices: usize,
    /// Why there are not as many as were asked for.
    missed: Option<String>,
    /// What of how the whole surface hangs together the level has lost.
    lost: Vec<String>,
    /// Over both surfaces.
    rms_m: f64,
    rms_share: f64,
    /// The greatest distance found.
    hausdorff_m: f64,
    hausdorff_share: f64,
    /// From the whole surface to the level, and back.
    there: OneWay,
    back: OneWay,
    /// What the simplification took, from the level before it.
    ms: f64,
}

fn lod(args: &LodArgs) -> Result<()> {
    let folder = Folder::begin(&args.output)?;
    let model = open(&args.source.file, args.source.unit.into()).map_err(bad_input)?;
    let mesh = model.merged(&model.rest());
    let attributes = if args.normals { Attributes::Normals } else { Attributes::None };
    let targets = match args.steps {
        None => args.triangles.clone(),
        Some(steps) => ladder(mesh.triangles.len(), steps as usize, args.min),
    };
    if targets.is_empty() {
        let rule = format!("a level has fewer triangles than the mesh, here {}", mesh.triangles.len());
        return Err(bad_input(format!("min = {}: {rule}", args.min)));
    }
    let key = levels_key(&mesh, &targets, attributes);
    if let Some(known) = known(&args.output, &key) {
        return tell(&known, args, "as before");
    }
    let made = levels(&mesh, &targets, attributes)
        .map_err(|refused| bad_input(format!("{}: {refused}", args.source.file.display())))?;
    let whole = Measured::new(&mesh);
    let mut rows = Vec::new();
    for (number, level) in made.into_iter().enumerate() {
        rows.push(row(number + 1, level, &whole, &folder)?);
    }
    let levels = Levels {
        key,
        mesh_sha256: mesh.hash(),
        triangles: mesh.triangles.len(),
        diagonal_m: mesh.bounds().map_or(0.0, |bounds| bounds.diagonal()),
        guided_by: if args.normals { "positions and normals" } else { "positions" }.to_owned(),
        samples: SAMPLES,
        seed: SEED,
        levels: rows,
    };
    let ours = |name: &str| name.starts_with("level-") && name.ends_with(".glb");
    folder.finish(INDEX, serde_json::to_string_pretty(&levels)?.as_bytes(), ours)?;
    tell(&levels, args, "written")
}

/// Writes a level and says what it is.
fn row(number: usize, level: Level, whole: &Measured, folder: &Folder) -> Result<Row> {
    let Level { mesh, target, missed, lost, took, .. } = level;
    let Some(distance) = whole.distance(&Measured::new(&mesh), SAMPLES, SEED) else {
        return Err(bad_input(format!(
            "level {number}: a surface without an area is no distance from another"
        )));
    };
    let (triangles, vertices) = (mesh.triangles.len(), mesh.positions.len());
    let bytes = write_glb(&Model::from(mesh));
    let name = format!("level-{number:02}-{triangles}.glb");
    folder.add(&name, &bytes)?;
    Ok(Row {
        file: name,
        sha256: sha256(&bytes),
        target,
        triangles,
        vertices,
        missed: missed.map(|missed| missed.reason().to_owned()),
        lost,
        rms_m: distance.rms_m(),
        rms_share: distance.rms_m() / distance.diagonal_m,
        hausdorff_m: distance.hausdorff_m(),
        hausdorff_share: distance.hausdorff_m() / distance.diagonal_m,
        there: distance.there,
        back: distance.back,
        ms: milliseconds(took),
    })
}

fn milliseconds(took: Duration) -> f64 {
    took.as_secs_f64() * 1e3
}

/// The levels that a folder holds of this key, if all of them are there as they were written.
fn known(folder: &Path, key: &str) -> Option<Levels> {
    let levels: Levels = serde_json::from_slice(&std::fs::read(folder.join(INDEX)).ok()?).ok()?;
    let whole =
        |row: &Row| std::fs::read(folder.join(&row.file)).is_ok_and(|bytes| sha256(&bytes) == row.sha256);
    (levels.key == key && levels.levels.iter().all(whole)).then_some(levels)
}

fn tell(levels: &Levels, args: &LodArgs, state: &str) -> Result<()> {
    if args.json {
        return print_json(levels);
    }
    let cells = |row: &Row| {
        vec![
            row.file.clone(),
            row.triangles.to_string(),
            format!("{:.4}", row.rms_m * 1e3),
            format!("{:.4}", row.rms_share * 100.0),
            format!("{:.3}", row.hausdorff_m * 1e3),
            format!("{:.3}", row.hausdorff_share * 100.0),
            format!("{:.2}", row.there.normal_deg),
            format!("{:.2}", row.there.flat_normal_deg),
            format!("{:.1}", row.ms),
        ]
    };
    let header = [
        "level",
        "triangles",
        "rms mm",
        "rms %",
        "Hausdorff mm",
        "Hausdorff %",
        "normal °",
        "flat normal °",
        "ms",
    ];
    let rows: Vec<Vec<String>> = levels.levels.iter().map(cells).collect();
    print(&format!(
        "{}: {} triangles, diagonal {:.4} m; levels {state} in {}, guided by {}",
        args.source.file.display(),
        levels.triangles,
        levels.diagonal_m,
        args.output.display(),
        levels.guided_by
    ))?;
    print(&table(&header, &rows))?;
    for row in &levels.levels {
        if let Some(missed) = &row.missed {
            print(&format!("{}: {} triangles for {}: {missed}", row.file, row.triangles, row.target))?;
        }
        if !row.lost.is_empty() {
            print(&format!("{}: unlike the whole surface it has {}", row.file, row.lost.join(", ")))?;
        }
    }
    Ok(())
}
