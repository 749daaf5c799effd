//! What an effect costs: a scene and its plain counterpart, in turns.

use std::time::Duration;

use crate::render::{Budget, Render, RenderState, StopFlag};

/// Turns of both that count, after one that does not.
pub const TURNS: u32 = 9;

/// How much longer a camera path takes with something than without it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The median over the turns of the time per camera path with it, over that without it.
    pub median: f64,
    /// What a quarter of the turns lies below.
    pub lower: f64,
    /// What a quarter of the turns lies above.
    pub upper: f64,
}

impl Cost {
    /// Renders `with` and `without` in turns for about `time` together, each going on where it stopped, and compares what their
    /// camera paths take.
    pub fn measure(with: &Render, without: &Render, time: Duration) -> Self {
        let slice = time / (2 * (TURNS + 1));
        let mut states = [with, without].map(|render| render.start(render.settings().seed));
        let renders = [with, without];
        let mut quotients = Vec::new();
        for turn in 0..=TURNS {
            let mut seconds = [0.0; 2];
            // Who begins alternates: what gets slower or faster meanwhile is nobody's.
            for place in [0, 1].map(|place| (place + turn as usize) % 2) {
                seconds[place] = seconds_per_path(renders[place], &mut states[place], slice);
            }
            if turn > 0 {
                quotients.push(seconds[0] / seconds[1]);
            }
        }
        Self::of(quotients)
    }

    /// The median and the quartiles of `quotients`, of which there are some.
    fn of(mut quotients: Vec<f64>) -> Self {
        quotients.sort_by(f64::total_cmp);
        let last = quotients.len().saturating_sub(1);
        let at = |share: f64| {
            let place = (share * last as f64).round() as usize;
            quotients.get(place).copied().unwrap_or(f64::NAN)
        };
        Self {
            median: at(0.5),
            lower: at(0.25),
            upper: at(0.75),
        }
    }
}

/// Goes on with a render for the time `slice`, at least until some camera paths are done, and returns the wall-clock time of each.
fn seconds_per_path(render: &Render, state: &mut RenderState, slice: Duration) -> f64 {
    let (start, paths_before) = (state.duration(), state.statistics().camera_paths);
    let mut until = start;
    loop {
        // A batch is not begun where less than half of it would fit: if even one takes longer than a slice, as it may on a busy
        // machine, there must be more time.
        until += slice.max(until - start);
        render.advance(state, Budget::Time(until), &StopFlag::new(), &());
        let paths = state.statistics().camera_paths - paths_before;
        if paths > 0 {
            return (state.duration() - start).as_secs_f64() / paths as f64;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Settings;
    use crate::scene::{LoadOptions, Scene};

    /// Without an end, this would have none.
    #[test]
    fn slices_shorter_than_a_batch_are_enough() {
        let scene = Scene::built_in(&LoadOptions::default()).unwrap();
        let render = Render::new(scene.into(), Settings::default()).unwrap();
        let mut state = render.start(0);
        for _ in 0..3 {
            let seconds = seconds_per_path(&render, &mut state, Duration::from_nanos(100));
            assert!(seconds > 0.0);
        }
        assert!(state.statistics().camera_paths >= 3 * 256);
    }

    #[test]
    fn quartiles_are_of_the_turns() {
        let turns = [3.0, 1.0, 2.0, 9.0, 5.0, 4.0, 7.0, 8.0, 6.0];
        let cost = Cost::of(turns.to_vec());
        let expected = Cost {
            median: 5.0,
            lower: 3.0,
            upper: 7.0,
        };
        assert_eq!(cost, expected);
    }
}
