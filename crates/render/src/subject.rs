//! What a job asks of what it draws: little enough that a stage of meshes or a photographed plate could answer as a theatre does.

use kelir_scene::stage::{Stage, StageScene};
use kelir_scene::{Masks, Scene, Theatre, Timeline};

use kelir_frame::exposure::Rule;
use kelir_frame::{Backend, RenderError, Renderer, View};
use kelir_theatre::albedo::{self, PixelAlbedo};
use kelir_theatre::{exposure, penumbra, project};

use crate::{Technique, techniques};

/// What one image shows.
pub trait Subject: Clone {
    /// Width and height of what is shown, in one unit: an image has their ratio.
    fn sides(&self) -> [f64; 2];

    /// The radiance shown as white on images of all of these: what is written, or else the brightest that can be seen without shadow.
    fn white(all: &[Self], view: &View) -> f64;

    /// Bytes of memory that drawing it takes, about.
    fn bytes(&self, view: &View) -> u64;

    /// Whether all that a timeline moves is where it is in `other`, so that both look the same.
    fn same_staging(&self, other: &Self) -> bool;

    /// Whether a pixel is in penumbra, one flag a pixel.
    fn penumbra(&self, view: &View) -> Vec<bool>;

    /// By which the radiance is the irradiance that errors are measured in: E = π L / albedo.
    fn albedo(&self, view: &View) -> PixelAlbedo;

    /// The brightest irradiance without shadow, over pixels and channels: full scale of errors.
    fn brightest(&self, view: &View) -> f64;
}

/// Where subjects come from: a scene, as it was read.
pub trait Staged {
    /// What it shows.
    type Subject: Subject;

    /// What a drawing keeps of it from instant to instant.
    type Kept: Default;

    /// SHA-256 of all that its images depend on, hexadecimal.
    fn sha256(&self) -> &str;

    /// What messages call it.
    fn label(&self) -> &str;

    /// How it moves, if it does.
    fn timeline(&self) -> Option<&Timeline>;

    /// The scene as written.
    fn still(&self) -> Self::Subject;

    /// The scene at an instant of its timeline, seconds.
    fn at(&self, time_s: f64, kept: &mut Self::Kept) -> Self::Subject;

    /// All of it that white depends on, at an instant or as written; what only casts shadows need not be there.
    fn lit(&self, time_s: Option<f64>) -> Self::Subject;

    /// What draws its subjects. Errors: a knob out of range, or no adapter where there must be one.
    fn renderer(
        technique: &Technique,
        backend: Backend,
    ) -> Result<Box<dyn Renderer<Self::Subject>>, RenderError>;

    /// White for the scene: as it says, or by this rule; `time_s` is a still's instant, absent for the scene as written.
    fn white(&self, rule: Rule, view: &View, time_s: Option<f64>) -> f64 {
        let Some(timeline) = self.timeline().filter(|_| rule == Rule::Timeline) else {
            return Subject::white(&[self.lit(time_s)], view);
        };
        let mut all: Vec<Self::Subject> = Vec::new();
        for frame in 0..timeline.frame_count() {
            let lit = self.lit(Some(timeline.frame_time_s(frame)));
            if all.last().is_none_or(|last| !last.same_staging(&lit)) {
                all.push(lit);
            }
        }
        Subject::white(&all, view)
    }
}

/// The most memory that a drawing may take, bytes.
pub const MEMORY: u64 = 8 << 30;

/// Looks at a size before anything is allocated for it.
///
/// Errors: a size that is not the subject's ratio, or that takes more than [`MEMORY`].
pub fn check_view(subject: &impl Subject, view: &View) -> Result<(), RenderError> {
    view.check(subject.sides())?;
    let bytes = subject.bytes(view);
    if bytes <= MEMORY {
        return Ok(());
    }
    let gb = |bytes: u64| bytes as f64 / 1e9;
    let [w, h] = view.size;
    Err(RenderError::View(format!(
        "size = {w}x{h}: drawing that takes about {:.1} GB of memory, of which at most {:.1} GB are taken; ask for fewer pixels",
        gb(bytes),
        gb(MEMORY)
    )))
}

impl Subject for Theatre {
    fn sides(&self) -> [f64; 2] {
        project::sides_m(&self.screen)
    }

    fn white(all: &[Self], view: &View) -> f64 {
        exposure::white(all, view)
    }

    fn bytes(&self, view: &View) -> u64 {
        // A pixel has its albedo, radiance, error and codes, a few times over; of each source E⁰, its mean, share and layers.
        let sources = self.lamp.emitters.len() as u64 + 1;
        let pixels = view.size[0] as u64 * view.size[1] as u64;
        // A texel has its code and a sum of 64 bits.
        let texels =
            self.planes.iter().map(|p| (p.mask.width * p.mask.height * p.mask.channels) as u64).sum::<u64>();
        pixels * (64 + 48 * sources) + 16 * texels
    }

    fn same_staging(&self, other: &Self) -> bool {
        self.same_staging(other)
    }

    fn penumbra(&self, view: &View) -> Vec<bool> {
        penumbra::mask(self, view)
    }

    fn albedo(&self, view: &View) -> PixelAlbedo {
        albedo::on_grid(&self.screen, view)
    }

    fn brightest(&self, view: &View) -> f64 {
        exposure::brightest(self, view)
    }
}

impl Subject for Stage {
    fn sides(&self) -> [f64; 2] {
        [self.camera.aspect, 1.0]
    }

    fn white(all: &[Self], _: &View) -> f64 {
        kelir_stage::exposure::white(all)
    }

    fn bytes(&self, view: &View) -> u64 {
        let triangles = self.triangles() as u64;
        view.size[0] as u64 * view.size[1] as u64 * 128 + triangles * 256
    }

    fn same_staging(&self, other: &Self) -> bool {
        self.same_staging(other)
    }

    fn penumbra(&self, view: &View) -> Vec<bool> {
        kelir_stage::exposure::penumbra(self, view)
    }

    /// Surfaces have albedos of their own: what is measured is π times the radiance that is seen.
    fn albedo(&self, _: &View) -> PixelAlbedo {
        PixelAlbedo::Uniform([1.0; 3])
    }

    fn brightest(&self, _: &View) -> f64 {
        std::f64::consts::PI * kelir_stage::exposure::white(std::slice::from_ref(self))
    }
}

impl Staged for StageScene {
    type Subject = Stage;
    type Kept = ();

    fn sha256(&self) -> &str {
        self.sha256()
    }

    fn label(&self) -> &str {
        self.label()
    }

    fn timeline(&self) -> Option<&Timeline> {
        self.timeline()
    }

    fn still(&self) -> Stage {
        self.still()
    }

    fn at(&self, time_s: f64, (): &mut ()) -> Stage {
        self.at(time_s)
    }

    fn lit(&self, time_s: Option<f64>) -> Stage {
        time_s.map_or_else(|| self.still(), |time_s| self.at(time_s))
    }

    fn renderer(technique: &Technique, backend: Backend) -> Result<Box<dyn Renderer<Stage>>, RenderError> {
        techniques::stage_renderer(technique, backend)
    }
}

impl Staged for Scene {
    type Subject = Theatre;
    type Kept = Masks;

    fn sha256(&self) -> &str {
        self.sha256()
    }

    fn label(&self) -> &str {
        self.label()
    }

    fn timeline(&self) -> Option<&Timeline> {
        self.timeline()
    }

    fn still(&self) -> Theatre {
        self.still()
    }

    fn at(&self, time_s: f64, masks: &mut Masks) -> Theatre {
        self.theatre_at(time_s, masks)
    }

    fn lit(&self, time_s: Option<f64>) -> Theatre {
        // Exposure does not see puppets: only the lamp's path matters.
        let mut theatre = Theatre { planes: Vec::new(), ..self.still() };
        if let Some(time_s) = time_s {
            theatre.lamp.position_m = self.lamp_at(time_s);
        }
        theatre
    }

    fn renderer(technique: &Technique, backend: Backend) -> Result<Box<dyn Renderer<Theatre>>, RenderError> {
        techniques::renderer(technique, backend)
    }
}
