//! The rays of a batch, kept as the engine made them: what the intersection layer is measured with.

use crate::embree::Rays;

/// The rays of one batch in the order of tracing, before they were traced; in world space.
#[derive(Clone, Debug, Default)]
pub struct RecordedRays {
    /// Rays that look for the nearest surface, by bounce: camera rays, then those that left the first vertices, and so on.
    pub segments: Vec<Rays>,
    /// Rays that ask whether light arrives, by vertex: at the first vertices, the second, and so on. None without
    /// next-event estimation.
    pub shadows: Vec<Rays>,
}

#[cfg(test)]
mod tests {
    use std::error::Error;

    use crate::film::{Film, FilmSums};
    use crate::learning::Reliance;
    use crate::sampling::StreamKey;
    use crate::spectrum::Rgb;
    use crate::{LoadOptions, Render, Scene, Settings};

    use super::super::{PathCounts, TileJob, TraceBatches, Tracer};
    use super::*;

    #[test]
    fn every_ray_is_recorded_and_the_image_is_the_same() -> Result<(), Box<dyn Error>> {
        let scene = Scene::built_in(&LoadOptions {
            definitions: vec![("res".into(), "16".into())],
            ..LoadOptions::default()
        })?;
        let size = scene.film.crop.size;
        let render = Render::new(scene.into(), Settings::default())?;
        let key = StreamKey {
            seed: 1,
            tile: 0,
            pass: 0,
        };
        let job = TileJob {
            key,
            counts: PathCounts::Even(4),
            weight: 4.0,
            knowledge: None,
            learns: false,
            reliance: Reliance::ALL,
        };
        let mut tracer = Tracer::<Rgb>::default();

        let mut recorded_film = Film::new(size, FilmSums::default());
        let tile = &mut recorded_film.tiles_mut()[0];
        let rays = tracer.record(render.engine(), &job, tile);
        let counted = tracer.take_statistics();
        let total = |streams: &[Rays]| streams.iter().map(|rays| rays.len() as u64).sum::<u64>();
        assert_eq!(rays.segments[0].len(), 16 * 16 * 4);
        assert!(rays.segments.len() > 2 && rays.shadows.len() > 2);
        assert_eq!(total(&rays.segments), counted.rays);
        assert_eq!(total(&rays.shadows), counted.shadow_rays);
        let untraced = |rays: &Rays| rays.tfars().iter().all(|&t| t == f32::INFINITY);
        assert!(rays.segments[1..].iter().all(untraced));

        let mut film = Film::new(size, FilmSums::default());
        tracer.trace(render.engine(), &job, &mut film.tiles_mut()[0]);
        assert_eq!(film, recorded_film);
        Ok(())
    }
}
