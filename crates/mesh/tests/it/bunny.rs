//! A scanned surface: the bunny of Debian's package glmark2-data, where it is installed (`cargo xtask test` sees to that where it can).

use kelir_mesh::{Attributes, Format, Measured, Mesh, SAMPLES, Unit, check, levels, read};

const FILE: &str = "/usr/share/glmark2/models/bunny.obj";

fn bunny() -> Option<Mesh> {
    let Ok(bytes) = std::fs::read(FILE) else {
        eprintln!("skipped: {FILE} is not there; as root: apt-get install glmark2-data");
        return None;
    };
    let model = read(&bytes, Format::Obj, Unit::Metre, &mut |_| Err("no files beside it".to_owned()));
    let model = model.expect("it is read");
    Some(model.merged(&model.rest()))
}

/// VTK 9.7's vtkQuadricDecimation of the same file to as many triangles: rms over both surfaces, as a share of the diagonal. Measured with
/// vtkStaticCellLocator from 40,000 points of each surface; the same program finds .000328, .001188 and .003292 for these levels.
const VTK: [(usize, f64); 3] = [(5000, 0.000332), (1000, 0.001295), (300, 0.003843)];

#[test]
fn a_scan_is_simplified_as_well_as_by_vtk() {
    let Some(bunny) = bunny() else { return };
    let report = check(&bunny);
    assert_eq!((report.vertices, report.triangles, report.euler), (34_835, 69_666, 2));
    assert!(report.is_solid(), "{:?}", report.faults());
    let whole = Measured::new(&bunny);
    for attributes in [Attributes::None, Attributes::Normals] {
        let levels = levels(&bunny, &VTK.map(|(target, _)| target), attributes).expect("levels");
        let mut normals = Vec::new();
        for (level, (target, vtk)) in levels.iter().zip(VTK) {
            assert_eq!((level.mesh.triangles.len(), level.missed), (target, None));
            assert!(level.report.is_solid() && level.lost.is_empty(), "{:?}", level.lost);
            let distance = whole.distance(&Measured::new(&level.mesh), SAMPLES, 1).expect("surfaces");
            let share = distance.rms_m() / distance.diagonal_m;
            // With normals the surface may be a little less true.
            assert!(share <= 1.15 * vtk, "{attributes:?}, {target}: {share} against {vtk}");
            assert!(distance.hausdorff_m() > distance.rms_m() && distance.there.normal_deg < 30.0);
            normals.push(distance.there.normal_deg);
        }
        assert!(normals.is_sorted(), "{normals:?}");
        // Negative control: a coarser level is not as good as VTK's of five times as many.
        let coarse = whole.distance(&Measured::new(&levels[1].mesh), SAMPLES, 1).expect("surfaces");
        assert!(coarse.rms_m() / coarse.diagonal_m > 1.15 * VTK[0].1);
    }
}
