//! Scenes altered at random: each is refused or rendered, and nothing panics.

use std::num::{NonZeroU32, NonZeroUsize};
use std::sync::Arc;
use std::time::Duration;

use cohort::sampling::SamplerKind;
use cohort::{Budget, LoadOptions, Render, Scene, Settings, StopFlag, Strategy as Walk};
use cohort::{StrategyKind, StrategyOptions};
use proptest::prelude::*;

/// Most of what a scene file can say, small.
const SCENE: &str = r#"<scene version="3.0.0"><default name="spp" value="1"/>
<integrator type="path"><integer name="max_depth" value="4"/><boolean name="hide_emitters" value="false"/></integrator>
<sensor type="perspective"><string name="fov_axis" value="smaller"/><float name="fov" value="40"/>
<float name="near_clip" value="0.1"/><float name="far_clip" value="100"/>
<transform name="to_world"><lookat origin="0, 0, 6" target="0, 0, 0" up="0, 1, 0"/></transform>
<sampler type="independent"><integer name="sample_count" value="$spp"/><integer name="seed" value="3"/></sampler>
<film type="hdrfilm"><integer name="width" value="6"/><integer name="height" value="5"/>
<integer name="crop_offset_x" value="1"/><integer name="crop_width" value="4"/>
<rfilter type="gaussian"><float name="stddev" value="0.5"/></rfilter></film></sensor>
<bsdf type="twosided" id="white"><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.6, 0.5"/></bsdf></bsdf>
<bsdf type="diffuse" id="red"><spectrum name="reflectance" value="400:0.1, 600:0.2, 700:0.7"/></bsdf>
<shape type="sphere"><point name="center" x="1" y="0" z="0"/><float name="radius" value="0.5"/><ref id="white"/></shape>
<shape type="cylinder"><point name="p0" x="-1" y="0" z="0"/><point name="p1" x="0" y="1" z="0"/><ref id="red"/></shape>
<shape type="sphere"><point name="center" x="-1" y="-1" z="0"/><float name="radius" value="0.4"/><bsdf type="mask"><float name="opacity" value="0.7"/>
<bsdf type="roughdielectric"><string name="distribution" value="ggx"/><float name="alpha" value="0.2"/><float name="int_ior" value="1.6"/></bsdf></bsdf></shape>
<shape type="sphere"><point name="center" x="0" y="-1" z="0"/><float name="radius" value="0.4"/><bsdf type="principled">
<rgb name="base_color" value="0.4, 0.5, 0.6"/><float name="spec_trans" value="0.5"/><float name="eta" value="1.4"/><float name="clearcoat" value="0.5"/></bsdf></shape>
<shape type="sphere"><point name="center" x="1" y="-1" z="0"/><float name="radius" value="0.4"/><bsdf type="blendbsdf"><float name="weight" value="0.5"/>
<bsdf type="roughplastic"><float name="alpha" value="0.3"/></bsdf><bsdf type="normalmap"><rgb name="normalmap" value="0.6, 0.5, 0.9"/>
<bsdf type="roughconductor"><string name="material" value="Au"/><float name="alpha_u" value="0.1"/><float name="alpha_v" value="0.3"/></bsdf></bsdf></bsdf></shape>
<shape type="sphere"><point name="center" x="2" y="-1" z="0"/><float name="radius" value="0.4"/><bsdf type="dielectric">
<spectrum name="int_ior" type="sellmeier"><vector name="b" x="1" y="0.2" z="1"/><vector name="c" x="0.006" y="0.02" z="103"/></spectrum></bsdf></shape>
<shape type="disk"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance"><transform name="to_uv"><scale x="4"/></transform></texture></bsdf><transform name="to_world"><scale value="2"/><rotate x="1" angle="30"/></transform></shape>
<shape type="cube"><transform name="to_world"><translate y="-3"/></transform><ref id="white"/></shape>
<shape type="shapegroup" id="pair"><shape type="sphere"><float name="radius" value="0.2"/></shape><shape type="rectangle"><ref id="red"/></shape></shape>
<shape type="instance"><ref id="pair"/><transform name="to_world"><scale x="0.5" y="-1" z="2"/><translate x="1" y="1"/></transform></shape>
<shape type="instance"><ref id="pair"/></shape>
<shape type="rectangle"><transform name="to_world"><rotate y="1" angle="180"/><translate x="0" z="7"/></transform>
<emitter type="area"><float name="radiance" value="5"/></emitter></shape>
<emitter type="point"><point name="position" x="0" y="4" z="4"/></emitter>
<emitter type="constant"><rgb name="radiance" value="0.1"/></emitter></scene>"#;

/// The byte ranges of what stands between quotes.
fn quoted(text: &str) -> Vec<std::ops::Range<usize>> {
    let quotes: Vec<usize> = text.match_indices('"').map(|(at, _)| at).collect();
    quotes
        .chunks_exact(2)
        .map(|pair| pair[0] + 1..pair[1])
        .collect()
}

/// The byte ranges of whole tags.
fn tags(text: &str) -> Vec<std::ops::Range<usize>> {
    let starts = text.match_indices('<').map(|(at, _)| at);
    starts
        .filter_map(|at| Some(at..at + text[at..].find('>')? + 1))
        .collect()
}

#[derive(Clone, Debug)]
enum Mutation {
    Value(usize, String),
    DeleteTag(usize),
    RepeatTag(usize),
}

impl Mutation {
    fn apply(&self, text: &mut String) {
        let pick = |ranges: Vec<std::ops::Range<usize>>, index: usize| {
            (!ranges.is_empty()).then(|| ranges[index % ranges.len()].clone())
        };
        match self {
            Self::Value(index, value) => {
                if let Some(range) = pick(quoted(text), *index) {
                    text.replace_range(range, value);
                }
            }
            Self::DeleteTag(index) => {
                if let Some(range) = pick(tags(text), *index) {
                    text.replace_range(range, "");
                }
            }
            Self::RepeatTag(index) => {
                if let Some(range) = pick(tags(text), *index) {
                    let again = text[range.clone()].to_owned();
                    text.insert_str(range.end, &again);
                }
            }
        }
    }
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let number = prop_oneof![
        any::<f64>().prop_map(|number| format!("{number:e}")),
        any::<i64>().prop_map(|number| number.to_string()),
        (-3_i32..20).prop_map(|number| number.to_string()),
    ];
    let word = prop::sample::select(vec![
        "",
        "0",
        "-1",
        "1e-45",
        "1e38",
        "1e300",
        "-1e20",
        "1e18",
        "0.999999",
        "nan",
        "inf",
        "true",
        "0, 0, 0",
        "1, 2",
        "400:1, 300:2",
        "380:1e30, 780:0",
        "$spp",
        "$none",
        "sphere",
        "area",
        "white",
        "mitchell",
        "to_world",
        "é\u{301}",
    ]);
    let value = prop_oneof![3 => number, 2 => word.prop_map(str::to_owned)];
    prop_oneof![
        8 => (any::<usize>(), value).prop_map(|(index, value)| Mutation::Value(index, value)),
        1 => any::<usize>().prop_map(Mutation::DeleteTag),
        1 => any::<usize>().prop_map(Mutation::RepeatTag),
    ]
}

/// Renders `text` if it is a scene, and says whether it was: once plainly, and once learning from its passes.
fn try_render(text: &str) -> bool {
    let Ok(scene) = Scene::from_xml(text, &LoadOptions::default()) else {
        return false;
    };
    // Large images are no fault of a scene, but take long.
    if scene.film.crop.size.pixels() > 4096 {
        return false;
    }
    let scene = Arc::new(scene);
    let plain = Settings::default();
    let learning = Settings {
        strategy: particle_filter(),
        sampler: SamplerKind::ArrayQmc,
        guiding: true,
        ..Settings::default()
    };
    // Passes of 1, 1 and 2 samples, which learn from each other.
    render(&scene, plain, 1) && render(&scene, learning, 4)
}

fn particle_filter() -> Box<dyn Walk> {
    let strategy = StrategyKind::ParticleFilter.build(&StrategyOptions::default());
    strategy.expect("defaults are valid")
}

/// Renders `scene` if its settings are valid, and says whether they were.
fn render(scene: &Arc<Scene>, settings: Settings, spp: u32) -> bool {
    let settings = Settings {
        budget: Budget::Time(Duration::MAX),
        threads: NonZeroUsize::MIN,
        max_depth: NonZeroU32::new(4),
        ..settings
    };
    let Ok(render) = Render::new(Arc::clone(scene), settings) else {
        return false;
    };
    let until = Budget::SamplesPerPixel(NonZeroU32::new(spp).expect("there are samples"));
    let mut state = render.start(0);
    render.advance(&mut state, until, &StopFlag::new(), &());
    let image = state.film().image();
    let mut values = image.pixels().iter().flatten();
    assert!(values.all(|value| value.is_finite()), "{}", scene.name);
    true
}

#[test]
fn the_scene_itself_is_right() {
    assert!(try_render(SCENE));
}

/// What there is to learn of may be nothing, a point, larger than numbers can say, or brighter.
#[test]
fn extreme_scenes_are_rendered() {
    let film = r#"<film type="hdrfilm"><integer name="width" value="4"/><integer name="height" value="4"/></film>"#;
    let look = r#"<transform name="to_world"><lookat origin="0, 0, 6" target="0, 0, 0" up="0, 1, 0"/></transform>"#;
    let ball = |radius: f32, more: &str| {
        format!(r#"<shape type="sphere"><float name="radius" value="{radius:e}"/>{more}</shape>"#)
    };
    let sky = |radiance: &str| {
        format!(r#"<emitter type="constant"><rgb name="radiance" value="{radiance}"/></emitter>"#)
    };
    let lamp = |radiance: &str| {
        format!(r#"<emitter type="area"><rgb name="radiance" value="{radiance}"/></emitter>"#)
    };
    let scenes = [
        String::new(),
        sky("1"),
        ball(1.0, ""),
        ball(1e-30, "") + &sky("1"),
        ball(1e18, "") + &ball(1.0, "") + &sky("1"),
        ball(1e30, &lamp("1")) + &ball(1.0, ""),
        ball(1.0, "") + &sky("3e38"),
        ball(1.0, "") + &sky("1e-38"),
        ball(1.0, &lamp("3e38")) + &ball(9.0, r#"<boolean name="flip_normals" value="true"/>"#),
        ball(1.0, &lamp("1e30")) + &ball(9.0, r#"<boolean name="flip_normals" value="true"/>"#),
    ];
    for content in scenes {
        let text = format!(
            r#"<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="40"/>{look}{film}</sensor>{content}</scene>"#
        );
        if let Err(error) = Scene::from_xml(&text, &LoadOptions::default()) {
            println!("{content}: {error}");
        } else {
            assert!(try_render(&text), "{content}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, max_shrink_iters: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_mutation_panics(mutations in prop::collection::vec(mutation(), 1..4)) {
        let mut text = SCENE.to_owned();
        for mutation in &mutations {
            mutation.apply(&mut text);
        }
        try_render(&text);
    }
}
