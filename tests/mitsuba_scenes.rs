//! Little scenes against Mitsuba 3: everything that the paper's scenes do not use.
//!
//! The scenes are `tests/scenes/*.xml` and those of the gallery, `scenes/gallery/*.xml`; their `$name`s make several cases of each.

mod support;

use std::path::PathBuf;
use std::sync::Arc;

use cohort::render::{ColourMode, Settings, WavelengthCount};
use cohort::scene::{LoadOptions, ReconstructionFilter, Scene};
use cohort::transport::DirectLight;

use support::comparison::Comparison;
use support::files;
use support::mitsuba::{Mitsuba, Reference};
use support::render::replicates;

/// Images of ours, and samples per pixel of each: two passes.
const OURS: (u64, u32) = (24, 20);
/// Images of Mitsuba, and samples per pixel of each.
const REFERENCE: (u32, u32) = (48, 32);
/// The same where a filter is wider than a pixel. Mitsuba then divides by the sum of the weights that a pixel got, and
/// such a ratio is biased where the image has an edge, by a share that falls with the number of samples.
const FILTERED_REFERENCE: (u32, u32) = (16, 128);
/// Side of the blocks in pixels.
const BLOCK: usize = 4;

/// What scenes of `tests/scenes` read.
const INPUTS: [&str; 9] = [
    "fragments/floor.xml",
    "fragments/row.xml",
    "octahedron.obj",
    "tent.obj",
    "sky.pfm",
    "coloured.ply",
    "colours.png",
    "heights.png",
    "normals.png",
];

/// What scenes of the gallery read.
const GALLERY_INPUTS: [&str; 7] = [
    "camera.xml",
    "stage.xml",
    "lamp.xml",
    "tiles.png",
    "heights.png",
    "normals.png",
    "sky.pfm",
];

/// A scene of a folder with values for its `$name`s.
struct Case {
    folder: &'static str,
    inputs: &'static [&'static str],
    scene: &'static str,
    definitions: Vec<(String, String)>,
    colour: ColourMode,
}

impl Case {
    fn new(scene: &'static str, definitions: &[(&str, &str)]) -> Self {
        Self {
            folder: "tests/scenes",
            inputs: &INPUTS,
            scene,
            definitions: definitions
                .iter()
                .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
                .collect(),
            colour: ColourMode::Rgb,
        }
    }

    /// A scene of the gallery, small.
    fn of_gallery(scene: &'static str) -> Self {
        Self {
            folder: "scenes/gallery",
            inputs: &GALLERY_INPUTS,
            ..Self::new(scene, &[("size", "48"), ("depth", "5")])
        }
    }

    fn in_wavelengths(self) -> Self {
        Self {
            colour: ColourMode::default(),
            ..self
        }
    }

    fn path(&self) -> PathBuf {
        self.file(&format!("{}.xml", self.scene))
    }

    fn file(&self, name: &str) -> PathBuf {
        files::of_project(&format!("{}/{name}", self.folder))
    }

    fn load(&self) -> Arc<Scene> {
        let options = LoadOptions {
            definitions: self.definitions.clone(),
            models: None,
        };
        let scene = Scene::load(self.path(), &options);
        Arc::new(scene.unwrap_or_else(|error| panic!("{error}")))
    }

    /// Everything that scenes of its folder read.
    fn inputs(&self) -> Vec<PathBuf> {
        self.inputs.iter().map(|name| self.file(name)).collect()
    }

    fn settings(&self) -> Settings {
        Settings {
            colour: self.colour,
            ..Settings::default()
        }
    }

    /// Compares our image, by the strategy that decides by default, with Mitsuba's.
    fn check(&self) {
        let what = format!(
            "{} {:?}, {}",
            self.scene,
            self.definitions,
            self.colour.name()
        );
        let Some(mitsuba) = Mitsuba::find(&what) else {
            return;
        };
        let scene = self.load();
        let path = self.path();
        let (seeds, spp) = match scene.film.filter {
            ReconstructionFilter::Box => REFERENCE,
            _ => FILTERED_REFERENCE,
        };
        let reference = Reference {
            scene: &path,
            inputs: &self.inputs(),
            definitions: &self.definitions,
            colour: self.colour,
            max_depth: None,
            seeds,
            spp,
        };
        let reference = mitsuba.render(&reference, scene.film.crop.size);
        let ours = replicates(&scene, self.settings(), 0..OURS.0, OURS.1);
        Comparison::new(what, &ours, &reference, BLOCK).assert();
    }
}

macro_rules! cases {
    ($($(#[$attribute:meta])* $name:ident: $scene:literal $([$($key:literal = $value:expr),*])? $($wavelengths:ident)?;)*) => {$(
        #[test]
        $(#[$attribute])*
        fn $name() {
            Case::new($scene, &[$($(($key, $value)),*)?])$(.$wavelengths())?.check();
        }
    )*};
}

cases! {
    sphere_light_from_outside: "sphere-light";
    sphere_light_in_wavelengths: "sphere-light" in_wavelengths;
    sphere_light_from_inside: "inside-a-light";
    cylinder_lights: "cylinder-light";
    disk_cube_and_mesh_lights: "flat-lights";
    point_lights: "point-lights";
    point_lights_in_wavelengths: "point-lights" in_wavelengths;
    many_emitters: "many-emitters";
    many_emitters_in_wavelengths: "many-emitters" in_wavelengths;
    emission_only: "many-emitters" ["depth" = "1"];
    direct_light_only: "many-emitters" ["depth" = "2"];
    one_bounce_of_indirect_light: "many-emitters" ["depth" = "3"];
    no_depth_at_all: "many-emitters" ["depth" = "0"];
    hidden_emitters: "many-emitters" ["hide" = "true"];
    hidden_emitters_of_all_shapes: "flat-lights" ["hide" = "true"];

    directional_and_spot_lights: "distant-lights";
    directional_and_spot_lights_in_wavelengths: "distant-lights" in_wavelengths;
    sky: "sky";
    sky_in_wavelengths: "sky" in_wavelengths;
    sky_sampled_where_it_is_bright: "sky" ["compensate" = "true"];
    hidden_sky: "sky" ["hide" = "true"];

    lens: "lens";
    wide_lens_in_focus_nearby: "lens" ["radius" = "0.5", "focus" = "2.8"];
    lens_with_clipping_planes: "lens" ["near" = "4.5", "far" = "7", "hide" = "true"];
    orthographic: "parallel";
    tall_orthographic: "parallel" ["width" = "32", "height" = "52"];
    orthographic_with_clipping_planes: "parallel" ["near" = "4.5", "far" = "7", "hide" = "true"];

    direct: "direct";
    direct_hidden: "direct" ["hide" = "true"];
    direct_by_emitters: "direct" ["bsdf_samples" = "0"];
    direct_by_bsdfs: "direct" ["emitter_samples" = "0"];
    direct_by_many_samples: "direct" ["emitter_samples" = "3", "bsdf_samples" = "5"];

    two_sides: "sides";
    two_sides_flipped: "sides" ["flip" = "true"];
    two_sides_mirrored: "sides" ["mirror" = "-1"];
    two_sides_mirrored_and_flipped: "sides" ["mirror" = "-1", "flip" = "true"];

    smooth_meshes: "meshes";
    flat_meshes: "meshes" ["flat" = "true"];

    box_filter: "camera";
    tent_filter: "camera" ["filter" = "tent"];
    gaussian_filter: "camera" ["filter" = "gaussian"];
    mitchell_filter: "camera" ["filter" = "mitchell"];
    gaussian_filter_beyond_the_border: "camera" ["filter" = "gaussian", "border" = "true"];
    crop_window: "camera" ["crop_x" = "13", "crop_y" = "7", "crop_width" = "30", "crop_height" = "21"];
    crop_window_with_a_wide_filter:
        "camera" ["crop_x" = "13", "crop_y" = "7", "crop_width" = "30", "crop_height" = "21", "filter" = "gaussian"];
    field_of_view_along_y: "camera" ["axis" = "y"];
    field_of_view_along_the_diagonal: "camera" ["axis" = "diagonal"];
    field_of_view_along_the_smaller_side: "camera" ["axis" = "smaller"];
    field_of_view_along_the_larger_side: "camera" ["axis" = "larger", "width" = "36", "height" = "52"];
    shifted_principal_point: "camera" ["shift_x" = "0.1", "shift_y" = "-0.2"];
    shifted_principal_point_in_a_crop_window:
        "camera" ["shift_x" = "0.1", "crop_x" = "20", "crop_width" = "33", "crop_y" = "4", "crop_height" = "30"];
    near_and_far_clip: "camera" ["near" = "6.2", "far" = "8"];
    hidden_surroundings: "camera" ["hide" = "true"];

    metals_and_glass: "metals-and-glass";
    metals_and_glass_in_wavelengths: "metals-and-glass" in_wavelengths;
    plastics: "plastics";
    plastics_in_wavelengths: "plastics" in_wavelengths;
    textures: "textures";
    textures_in_wavelengths: "textures" in_wavelengths;
    instances: "instances";
    instances_in_wavelengths: "instances" in_wavelengths;
    instances_of_flipped_shapes: "instances" ["flip" = "true", "mirror" = "1"];
    instances_of_flipped_shapes_mirrored: "instances" ["flip" = "true"];

    colours: "colours";
    colours_in_wavelengths: "colours" in_wavelengths;
}

/// The scenes of the gallery, each by the colours in which its effect shows.
mod gallery {
    use super::Case;

    macro_rules! scenes {
        ($($name:ident: $scene:literal $($wavelengths:ident)?;)*) => {$(
            #[test]
            fn $name() {
                Case::of_gallery($scene)$(.$wavelengths())?.check();
            }
        )*};
    }

    scenes! {
        matte: "matte";
        mirror: "mirror" in_wavelengths;
        glass: "glass";
        rough_glass: "rough-glass";
        rough_metal: "rough-metal" in_wavelengths;
        plastic: "plastic";
        principled: "principled";
        textures: "textures" in_wavelengths;
        bump: "bump";
        mask: "mask";
        envmap: "envmap" in_wavelengths;
        spot: "spot";
        directional: "directional";
        projector: "projector" in_wavelengths;
        textured_light: "textured-light" in_wavelengths;
        many_lights: "many-lights";
        instances: "instances" in_wavelengths;
        thin_lens: "thin-lens";
        orthographic: "orthographic";
    }
}

/// Mixed materials. Mitsuba's `blendbsdf` is no reference: under
/// a constant light, a sphere half mirror and half diffuse with reflectance 0.5 sends back 0.693 of it in 3.9.1, and 0.75 in truth
/// (`lights_and_lenses.rs`).
#[test]
fn blends_are_the_same_however_light_is_found() {
    same_however_light_is_found(&Case::of_gallery("blend"));
}

/// Mitsuba knows no dispersion. But paths that carry a single wavelength each are refracted by its index alone, and those that
/// carry four give the same image.
#[test]
fn dispersion_is_that_of_single_wavelengths() {
    let case = Case::of_gallery("dispersion");
    let scene = case.load();
    let images = |count| {
        let settings = Settings {
            colour: ColourMode::Spectral(count),
            ..Settings::default()
        };
        replicates(&scene, settings, 0..OURS.0, 8 * OURS.1)
    };
    Comparison::new(
        "dispersion: one wavelength and four",
        &images(WavelengthCount::Four),
        &images(WavelengthCount::One),
        BLOCK,
    )
    .assert();
}

/// Lights whose vertex normals are not those of their faces: Mitsuba converts densities by the wrong one of the two
/// (`DirectionSample::n` is the shading normal there), so that its own direct light is wrong. What is right is what
/// paths find that meet the light by chance, which use no density of the light.
#[test]
fn smooth_lights_are_the_same_however_they_are_found() {
    same_however_light_is_found(&Case::new("smooth-light", &[]));
}

/// Of some of these shapes and textures, Mitsuba cannot find points by their texture coordinates, as it does for lights.
#[test]
fn textured_lights_are_the_same_however_they_are_found() {
    same_however_light_is_found(&Case::new("textured-lights", &[]).in_wavelengths());
}

/// Light that is sought and light that is met by chance make the same image.
fn same_however_light_is_found(case: &Case) {
    let scene = case.load();
    let by_chance = Settings {
        direct_light: DirectLight::Off,
        ..case.settings()
    };
    let found = replicates(&scene, by_chance, 0..24, 160);
    let sought = replicates(&scene, case.settings(), 0..OURS.0, 2 * OURS.1);
    let what = format!("{}: sought and found by chance", case.scene);
    Comparison::new(what, &sought, &found, BLOCK).assert();
}
