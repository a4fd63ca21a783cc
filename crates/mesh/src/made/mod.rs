//! Models that ship: made of arithmetic when they are asked for, the same bits on every machine.

mod amphora;
mod field;
mod hare;
mod horse;
mod polygonise;

use glam::DVec3;

use self::field::at;
use crate::model::{Node, Part, Transform};
use crate::{Mesh, Model};

/// A model that ships.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Made {
    /// A hare that sits up, with its coat.
    Hare,
    /// A fluted amphora with two handles.
    Amphora,
    /// A horse with four legs that turn about their pivots.
    Horse,
}

impl Made {
    /// Every one.
    pub const ALL: [Made; 3] = [Made::Hare, Made::Amphora, Made::Horse];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Made::Hare => "hare",
            Made::Amphora => "amphora",
            Made::Horse => "horse",
        }
    }

    /// What it is, in a few words.
    pub fn shows(self) -> &'static str {
        match self {
            Made::Hare => "a hare that sits up, with its coat",
            Made::Amphora => "a fluted amphora with two handles",
            Made::Horse => "a horse, its four legs nodes of their own that turn about their pivots",
        }
    }

    /// Of a name.
    pub fn of(name: &str) -> Option<Made> {
        Made::ALL.into_iter().find(|made| made.name() == name)
    }

    /// Makes it: some tenths of a second.
    pub fn make(self) -> Model {
        match self {
            Made::Hare => {
                let solid = hare::solid();
                let field = |p: DVec3| solid.at(p);
                let hare =
                    surface(&field, &hare::relief, [at(-0.19, -0.02, -0.11), at(0.15, 0.38, 0.11)], SIDES[0]);
                Mesh { base_colour: [0.5, 0.36, 0.24], ..hare }.into()
            }
            Made::Amphora => {
                let field = amphora::field();
                let amphora = surface(
                    &field,
                    &amphora::relief,
                    [at(-0.15, -0.02, -0.14), at(0.15, 0.42, 0.14)],
                    SIDES[1],
                );
                Mesh { base_colour: [0.6, 0.25, 0.12], ..amphora }.into()
            }
            Made::Horse => horse(),
        }
    }
}

/// Sides of the lattice that the surfaces are found on, metres: they decide how many triangles there are.
const SIDES: [f64; 4] = [0.00576, 0.0070, 0.0090, 0.0088];

fn surface(
    field: &(dyn Fn(DVec3) -> f64 + Sync),
    relief: &(dyn Fn(DVec3) -> f64 + Sync),
    [min, max]: [DVec3; 2],
    side: f64,
) -> Mesh {
    let mut net = polygonise::net(field, min, max, side);
    net.relax(field, 6);
    net.displace(field, relief);
    let round = |p: &DVec3| [p.x as f32, p.y as f32, p.z as f32];
    Mesh::new(net.positions.iter().map(round).collect(), net.triangles)
}

fn horse() -> Model {
    let colour = [0.32, 0.20, 0.12];
    let solid = horse::body();
    let body =
        surface(&|p| solid.at(p), &horse::relief, [at(-0.32, 0.06, -0.09), at(0.34, 0.50, 0.09)], SIDES[2]);
    let part = |mesh: Mesh| vec![Part { mesh: Mesh { base_colour: colour, ..mesh }, weights: None }];
    let mut nodes = vec![Node { name: "body".to_owned(), parts: part(body), ..Node::default() }];
    for (name, pivot) in horse::LEGS {
        let solid = horse::leg(name);
        let relief = |p: DVec3| horse::relief(p + pivot);
        let leg =
            surface(&|p| solid.at(p), &relief, [at(-0.07, -0.26, -0.06), at(0.09, 0.10, 0.06)], SIDES[3]);
        let rest = Transform { translation: pivot, ..Transform::default() };
        nodes.push(Node { name: name.to_owned(), parent: Some(0), rest, parts: part(leg) });
    }
    Model { nodes, ..Model::default() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;
    use crate::{check, check_model};

    /// Triangles, parts, Euler number, and the hash of the whole at rest: the same on every machine.
    const KNOWN: [(Made, usize, usize, i64, &str); 3] = [
        (Made::Hare, 68_960, 1, 2, "2b25d0e7b025184eb86ebfac03a8922910d1723f303a24767312aec5badac597"),
        // Two handles.
        (Made::Amphora, 68_980, 1, -2, "342236fcabd256f231c0159b780d3b2abe26017c98cb1212c3536fd0f0f651a4"),
        (Made::Horse, 70_004, 5, 10, "424aebf652c412bd550e76f7346cc424825bd0a750a86cf5e018ea8f4ce295cd"),
    ];

    #[test]
    fn models_are_solid_and_the_same_on_every_machine() {
        for (made, triangles, parts, euler, hash) in KNOWN {
            let model = made.make();
            let report = check_model(&model);
            assert!(report.is_solid(), "{made:?}: {:?}", report.faults());
            let mesh = model.merged(&model.rest());
            assert_eq!((report.parts, report.euler), (parts, euler), "{made:?}");
            assert_eq!((report.triangles, mesh.hash().as_str()), (triangles, hash), "{made:?}");
            // The paper's model has about 69,000.
            assert!((68_000..=71_000).contains(&triangles));
            let bounds = mesh.bounds().unwrap();
            assert!(bounds.min[1].abs() < 0.003, "{made:?} stands at {}", bounds.min[1]);
            assert!((0.3..0.6).contains(&(bounds.max[1] - bounds.min[1])));
            assert_eq!(Made::of(made.name()), Some(made));
        }
    }

    /// What rounds otherwise on another machine, or may: all but + − × ÷ √.
    #[test]
    fn models_are_made_of_arithmetic_alone() {
        const OTHER: [&str; 9] =
            [".sin", ".cos(", ".tan(", ".atan", ".acos(", ".exp", ".pow", ".ln(", ".hypot("];
        let named = |text: &str| {
            let code = text.split("#[cfg(test)]").next().unwrap_or_default().to_owned();
            OTHER.into_iter().filter(|name| code.contains(name)).collect::<Vec<_>>()
        };
        for text in [
            include_str!("mod.rs"),
            include_str!("field.rs"),
            include_str!("polygonise.rs"),
            include_str!("hare.rs"),
            include_str!("amphora.rs"),
            include_str!("horse.rs"),
            include_str!("../random.rs"),
        ] {
            assert_eq!(named(text), Vec::<&str>::new());
            assert!(!text.split("#[cfg(test)]").next().unwrap_or_default().contains("mul_add"));
        }
        assert_eq!(named("let y = x.sin_cos();"), [".sin"]);
    }

    /// Fine relief: over much of the surface the shading normal is 5° and more from what it were without.
    #[test]
    fn the_relief_turns_normals() {
        let solid = hare::solid();
        let field = |p: DVec3| solid.at(p);
        let bounds = [at(-0.19, -0.02, -0.11), at(0.15, 0.38, 0.11)];
        let turned = |relief: &(dyn Fn(DVec3) -> f64 + Sync)| {
            let mesh = surface(&field, relief, bounds, 0.008);
            let smooth = surface(&field, &|_| 0.0, bounds, 0.008);
            let pairs = mesh.smooth_normals().into_iter().zip(smooth.smooth_normals());
            let cosines = pairs.map(|(a, b)| (0..3).map(|k| f64::from(a[k] * b[k])).sum::<f64>());
            let cosines: Vec<f64> = cosines.collect();
            cosines.iter().filter(|cosine| **cosine < 0.996).count() as f64 / cosines.len() as f64
        };
        assert!(turned(&hare::relief) > 0.4, "{}", turned(&hare::relief));
        // Negative control.
        assert_eq!(turned(&|_| 0.0), 0.0);
    }

    #[test]
    fn each_leg_of_the_horse_turns_about_its_pivot_alone() {
        let model = Made::Horse.make();
        for (name, pivot) in horse::LEGS {
            let leg = model.node(name).unwrap();
            let mut pose = model.rest();
            // A right angle about z: what hung down from the pivot points along +x.
            pose[leg].rotation = glam::DQuat::from_xyzw(0.0, 0.0, 0.5f64.sqrt(), 0.5f64.sqrt());
            for ((n, rest), (_, turned)) in model.posed(&model.rest()).into_iter().zip(model.posed(&pose)) {
                if n != leg {
                    assert_eq!(rest, turned);
                    continue;
                }
                for (from, to) in rest.positions.iter().zip(&turned.positions) {
                    let [from, to] = [from, to].map(|p| DVec3::from_array(p.map(f64::from)) - pivot);
                    assert!((to - at(-from.y, from.x, from.z)).length() < 1e-6);
                }
                let hoof = turned.bounds().unwrap();
                assert!(hoof.max[0] > pivot.x as f32 + 0.2 && hoof.min[1] > 0.1);
                assert!(check(&turned).is_solid());
                // Its upper end stays within the trunk.
                assert!(rest.bounds().unwrap().max[1] > 0.25);
            }
        }
    }
}
