//! Rounding: drawing integers n_k with given means nu_k.
//!
//! Lay the nu_k of a group end to end: particle k owns an interval of length nu_k, all of them together
//! \[0, N) with N = sum of nu_k. Drop points on \[0, N), of density 1 everywhere: as many of them as hit its interval
//! are the children of k, and E\[n_k\] = nu_k. The ways of rounding differ in how the points are dropped:
//!
//! | rounding | points | n_k |
//! |---|---|---|
//! | independent | one lattice of spacing 1 per particle | floor or ceiling of nu_k |
//! | multinomial | m' independent ones | noise of a Poisson kind, even where nu_k is an integer |
//! | stratified | one in each of m' equal parts | off by less than 3 |
//! | systematic | one lattice of spacing 1 for the whole group | floor or ceiling of nu_k |
//!
//! m', the group's number of children, is floor(N) or ceil(N) with mean N for every joint rounding. *Residual* rounding
//! gives floor(nu_k) children for certain and drops points on the fractions only.
//!
//! Systematic rounding has the least variance that an integer with mean nu_k can have, and neighbours hold each other
//! in balance: where one got more than its share the next gets less. It wins when neighbours contribute alike.
//! (Kitagawa 1996 introduced stratified and systematic resampling, Liu and Chen 1998 residual; Douc, Cappé and
//! Moulines 2005 compare their variances.)
//!
//! Independent and systematic rounding are exact; stratified and multinomial points have the 53-bit resolution of `f64`.

use std::fmt::{self, Display};
use std::str::FromStr;

use serde::{Serialize, Serializer};

use super::{Child, ExpectedCount, Population, SettingError};
use crate::sampling::RandomStream;

/// A way of drawing integers with given means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// floor(nu), plus 1 with the probability of the fraction, for each particle alone.
    Independent,
    /// Parents drawn with replacement: the paper's way (figure 5).
    Multinomial,
    /// One child from each of m' equal parts of the population.
    Stratified,
    /// A lattice with one random shift.
    Systematic,
    /// floor(nu) for certain, and the fractions by another way.
    Residual(ResidualRest),
}

/// How residual rounding draws what is left of the expected counts.
///
/// Only two ways are worth a name: independent and systematic rounding give floor(nu) for certain as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResidualRest {
    /// By [`Rounding::Multinomial`], as in the literature.
    Multinomial,
    /// By [`Rounding::Stratified`].
    Stratified,
}

impl Rounding {
    /// Every way of rounding.
    pub const ALL: [Self; 6] = [
        Self::Independent,
        Self::Multinomial,
        Self::Stratified,
        Self::Systematic,
        Self::Residual(ResidualRest::Multinomial),
        Self::Residual(ResidualRest::Stratified),
    ];

    /// Appends the children of `population`, whose expected counts are `nu`, in the order of their parents. The groups of
    /// the population round jointly.
    pub(super) fn draw(
        self,
        nu: &[ExpectedCount],
        population: &Population,
        random: &mut RandomStream,
        children: &mut Vec<Child>,
    ) {
        let group = population.group;
        match self {
            Self::Independent => independently(nu, population, random, children),
            Self::Multinomial => jointly::<Multinomial>(nu, group, Share::all, random, children),
            Self::Stratified => jointly::<Stratified>(nu, group, Share::all, random, children),
            Self::Systematic => jointly::<Systematic>(nu, group, Share::all, random, children),
            Self::Residual(ResidualRest::Multinomial) => {
                jointly::<Multinomial>(nu, group, Share::fraction, random, children);
            }
            Self::Residual(ResidualRest::Stratified) => {
                jointly::<Stratified>(nu, group, Share::fraction, random, children);
            }
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Multinomial => "multinomial",
            Self::Stratified => "stratified",
            Self::Systematic => "systematic",
            Self::Residual(ResidualRest::Multinomial) => "residual",
            Self::Residual(ResidualRest::Stratified) => "residual-stratified",
        }
    }
}

impl Display for Rounding {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Rounding {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        SettingError::choose("counts", text, &Self::ALL)
    }
}

impl Serialize for Rounding {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// Rounds each count by itself.
fn independently(
    nu: &[ExpectedCount],
    population: &Population,
    random: &mut RandomStream,
    children: &mut Vec<Child>,
) {
    for (parent, &nu) in (0..).zip(nu) {
        let count = nu.round(|| match population.points {
            Some(points) => points.bits(parent as usize, population.depth, random),
            None => random.bits(),
        });
        bear(children, parent, nu, count);
    }
}

/// How an expected count is divided between certainty and the points.
struct Share {
    certain: u64,
    by_points: ExpectedCount,
}

impl Share {
    /// Everything by points.
    fn all(nu: ExpectedCount) -> Self {
        Self {
            certain: 0,
            by_points: nu,
        }
    }

    /// Only the fraction by points.
    fn fraction(nu: ExpectedCount) -> Self {
        Self {
            certain: nu.whole(),
            by_points: nu.fraction(),
        }
    }
}

/// Rounds each group by itself.
fn jointly<P: Points>(
    nu: &[ExpectedCount],
    group: &[u32],
    share: impl Fn(ExpectedCount) -> Share,
    random: &mut RandomStream,
    children: &mut Vec<Child>,
) {
    let mut first = 0;
    for members in group.chunk_by(|one, next| one == next) {
        let nu = &nu[first..first + members.len()];
        let total = nu.iter().map(|&nu| share(nu).by_points).sum();
        deal(
            nu,
            first as u32,
            &share,
            P::drop_on(total, random),
            children,
        );
        first += members.len();
    }
}

/// Gives each particle of one group its certain children and those of the `points` that hit its interval.
///
/// An interval contains its beginning and not its end, so that a point on a border never hits an empty one.
fn deal(
    nu: &[ExpectedCount],
    first: u32,
    share: impl Fn(ExpectedCount) -> Share,
    points: impl Iterator<Item = u64>,
    children: &mut Vec<Child>,
) {
    let mut points = points.peekable();
    let mut end = 0;
    for (parent, &nu) in (first..).zip(nu) {
        let Share { certain, by_points } = share(nu);
        end += by_points.units();
        let mut count = certain;
        while points.next_if(|&point| point < end).is_some() {
            count += 1;
        }
        bear(children, parent, nu, count);
    }
}

/// Appends `count` children of a particle with the expected count `nu`.
#[inline]
fn bear(children: &mut Vec<Child>, parent: u32, nu: ExpectedCount, count: u64) {
    if count > 0 {
        let weight = nu.child_weight();
        for _ in 0..count {
            children.push(Child { parent, weight });
        }
    }
}

/// A way of dropping points on the interval \[0, `total`) with density 1.
trait Points {
    /// The points in ascending order, in units of 2^-32; floor(total) or ceil(total) of them.
    fn drop_on(total: ExpectedCount, random: &mut RandomStream) -> impl Iterator<Item = u64>;
}

/// Points at u, u + 1, u + 2, ... with one uniform u.
struct Systematic;

impl Points for Systematic {
    fn drop_on(total: ExpectedCount, random: &mut RandomStream) -> impl Iterator<Item = u64> {
        let shift = u64::from(random.bits());
        (shift..total.units()).step_by(1 << 32)
    }
}

/// One uniform point in each of m' equal parts.
struct Stratified;

impl Points for Stratified {
    fn drop_on(total: ExpectedCount, random: &mut RandomStream) -> impl Iterator<Item = u64> {
        let parts = total.round(|| random.bits());
        let length = total.units() as f64 / parts as f64;
        (0..parts).map(move |part| {
            let point = (part as f64 + random.uniform_f64()) * length;
            (point as u64).min(total.units() - 1)
        })
    }
}

/// m' independent uniform points.
struct Multinomial;

impl Points for Multinomial {
    /// Draws the points in order, so that nothing has to be sorted or searched: the largest of k uniform numbers on
    /// \[0, r) is r U^(1/k), and the others are uniform below it (Bentley and Saxe 1980). Taken from the far end, the
    /// order ascends.
    fn drop_on(total: ExpectedCount, random: &mut RandomStream) -> impl Iterator<Item = u64> {
        let points = total.round(|| random.bits());
        let end = total.units() as f64;
        let mut remaining = end;
        (1..=points).rev().map(move |left| {
            remaining *= (random.uniform_f64().ln() / left as f64).exp();
            ((end - remaining) as u64).min(total.units() - 1)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::StreamKey;

    /// The parents hit by points at `at`, in units of 2^-32, where every other particle is worth nothing.
    fn parents(at: &[u64]) -> Vec<u32> {
        let one = ExpectedCount::positive(1.0);
        let nu = [
            ExpectedCount::ZERO,
            one,
            ExpectedCount::ZERO,
            one,
            ExpectedCount::ZERO,
        ];
        let mut children = Vec::new();
        deal(&nu, 10, Share::all, at.iter().copied(), &mut children);
        children.iter().map(|child| child.parent).collect()
    }

    #[test]
    fn points_on_a_border_hit_a_particle_that_is_worth_something() {
        const ONE: u64 = 1 << 32;
        assert_eq!(parents(&[0, ONE]), [11, 13]);
        assert_eq!(parents(&[ONE - 1, 2 * ONE - 1]), [11, 13]);
        assert_eq!(parents(&[0, 0, 1, ONE]), [11, 11, 11, 13]);
    }

    #[test]
    fn points_lie_inside_the_population_and_ascend() {
        fn check<P: Points>(random: &mut RandomStream) {
            for nu in [0.3, 1.0, 2.5, 1000.0] {
                let total = ExpectedCount::positive(nu);
                for _ in 0..1000 {
                    let points: Vec<_> = P::drop_on(total, random).collect();
                    assert!(
                        points.is_sorted() && points.iter().all(|&point| point < total.units())
                    );
                    let number = points.len() as f32;
                    assert!(number == nu.floor() || number == nu.ceil());
                }
            }
        }
        let mut random = RandomStream::new(StreamKey {
            seed: 1,
            tile: 0,
            pass: 0,
        });
        check::<Systematic>(&mut random);
        check::<Stratified>(&mut random);
        check::<Multinomial>(&mut random);
    }
}
