//! Discrete distributions sampled in constant time.

/// An alias table (Vose 1991) over a list of non-negative weights.
#[derive(Clone, Debug)]
pub struct AliasTable {
    bins: Vec<Bin>,
}

#[derive(Clone, Copy, Debug)]
struct Bin {
    /// Below this part of the bin the outcome is the bin itself, above it is `alias`.
    threshold: f32,
    alias: u32,
}

/// What [`AliasTable::sample`] drew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AliasSample {
    /// The outcome.
    pub index: usize,
    /// What is left of the uniform number, itself uniform in [0, 1).
    pub remainder: f32,
}

impl AliasTable {
    /// The table for `weights`, or `None` where they do not make a distribution: none is given, one is negative or
    /// not finite, or all are zero.
    pub fn new(weights: &[f32]) -> Option<Self> {
        let total: f64 = weights.iter().map(|&w| f64::from(w)).sum();
        let valid = total > 0.0 && total.is_finite() && weights.iter().all(|&w| w >= 0.0);
        if !valid {
            return None;
        }
        let scale = weights.len() as f64 / total;
        let mut mass: Vec<f64> = weights.iter().map(|&w| f64::from(w) * scale).collect();
        let (mut small, mut large): (Vec<u32>, Vec<u32>) =
            (0..weights.len() as u32).partition(|&i| mass[i as usize] < 1.0);
        let mut bins = vec![
            Bin {
                threshold: 1.0,
                alias: 0
            };
            weights.len()
        ];
        while let (Some(&less), Some(&more)) = (small.last(), large.last()) {
            small.pop();
            bins[less as usize] = Bin {
                threshold: mass[less as usize] as f32,
                alias: more,
            };
            mass[more as usize] -= 1.0 - mass[less as usize];
            if mass[more as usize] < 1.0 {
                large.pop();
                small.push(more);
            }
        }
        Some(Self { bins })
    }

    /// Draws an index with probability proportional to its weight, from `u` in [0, 1).
    #[inline]
    pub fn sample(&self, u: f32) -> AliasSample {
        let scaled = u * self.bins.len() as f32;
        let bin = (scaled as usize).min(self.bins.len() - 1);
        let within = (scaled - bin as f32).clamp(0.0, 1.0 - f32::EPSILON);
        let Bin { threshold, alias } = self.bins[bin];
        if within < threshold {
            AliasSample {
                index: bin,
                remainder: (within / threshold).min(1.0 - f32::EPSILON),
            }
        } else {
            let rest = (within - threshold) / (1.0 - threshold);
            AliasSample {
                index: alias as usize,
                remainder: rest.min(1.0 - f32::EPSILON),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{RandomStream, StreamKey};

    #[test]
    fn draws_by_weight() {
        let weights = [0.0, 3.0, 1.0, 0.5, 0.0, 5.5];
        let table = AliasTable::new(&weights).unwrap();
        let mut random = RandomStream::new(StreamKey {
            seed: 1,
            tile: 2,
            pass: 3,
        });
        let n = 200_000;
        let mut counts = [0u32; 6];
        let mut remainder = 0.0;
        for _ in 0..n {
            let sample = table.sample(random.uniform());
            counts[sample.index] += 1;
            remainder += f64::from(sample.remainder) / f64::from(n);
        }
        for (count, weight) in counts.iter().zip(weights) {
            let expected = f64::from(weight) / 10.0;
            let got = f64::from(*count) / f64::from(n);
            assert!(
                (got - expected).abs() < 4.0 * (expected / f64::from(n)).sqrt() + 1e-12,
                "{counts:?}"
            );
        }
        assert!((remainder - 0.5).abs() < 3e-3, "{remainder}");
    }

    #[test]
    fn refuses_what_is_no_distribution() {
        for weights in [
            &[][..],
            &[0.0, 0.0],
            &[1.0, -1.0],
            &[f32::NAN],
            &[f32::INFINITY],
        ] {
            assert!(AliasTable::new(weights).is_none(), "{weights:?}");
        }
    }
}
