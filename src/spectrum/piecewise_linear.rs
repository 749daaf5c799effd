//! A function of the wavelength by its values at some wavelengths, linear between them.

use super::error::{CurveError, Place};

/// A tabulated function, zero outside the range of its entries.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PiecewiseLinear {
    /// Entries at equal distances: found by one multiplication.
    Regular(RegularTable),
    /// Entries at increasing wavelengths: found by bisection.
    Irregular(IrregularTable),
}

/// Values at equal distances.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RegularTable {
    /// Wavelength of the first value, in nm.
    pub first_nm: f32,
    /// Wavelength of the last value, in nm.
    pub last_nm: f32,
    /// Entries per nm.
    pub entries_per_nm: f32,
    /// Of every entry but the last, at least one: its value, and the next one less it.
    pub intervals: Box<[Interval]>,
}

/// From one entry of a table to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    value: f32,
    difference: f32,
}

impl Interval {
    /// The value at a `fraction` of the way.
    #[inline(always)]
    pub fn at(&self, fraction: f32) -> f32 {
        self.value + fraction * self.difference
    }
}

/// Values at increasing wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct IrregularTable {
    /// At least two wavelengths, increasing, in nm.
    nm: Box<[f32]>,
    /// One value for each wavelength.
    values: Box<[f32]>,
}

/// A place between two entries of a table.
pub(super) struct GridPlace {
    /// The entry before.
    pub entry: u32,
    /// The fraction of the way to the next, in [0, 1].
    pub fraction: f32,
}

impl GridPlace {
    /// That of `position`, in entries; `last` is the last entry that has one behind it, at most 2^22. What lies on an entry may be
    /// found at the end of the way from the one before. Positions outside of the table become those of its ends.
    ///
    /// Conversions to integers by `as` look after numbers out of range and do not vectorise well. Adding 2^23 leaves the nearest
    /// integer in the last bits.
    #[inline(always)]
    pub(super) fn of(position: f32, last: f32) -> Self {
        const INTEGERS: f32 = (1 << 23) as f32;
        let integer = between(position - 0.5, 0.0, last) + INTEGERS;
        Self {
            entry: integer.to_bits() - INTEGERS.to_bits(),
            fraction: between(position - (integer - INTEGERS), 0.0, 1.0),
        }
    }
}

/// `number`, or the limit that it exceeds. The library's function also looks at the order of its limits.
#[inline(always)]
fn between(number: f32, least: f32, greatest: f32) -> f32 {
    let number = if number > least { number } else { least };
    if number < greatest { number } else { greatest }
}

/// How far, in steps, an entry may be from its place in a regular table: the rounding of wavelengths to `f32`.
const REGULARITY_TOLERANCE: f64 = 1e-4;

impl PiecewiseLinear {
    /// The function through the `entries` (wavelength in nm, value).
    ///
    /// # Errors
    /// Fewer than two entries, wavelengths that are not positive numbers, or that do not increase, and whatever
    /// `check` says of a value and its place.
    pub(super) fn new(
        entries: &[(f32, f32)],
        check: impl Fn(f32, Place) -> Result<(), CurveError>,
    ) -> Result<Self, CurveError> {
        if entries.len() < 2 {
            return Err(CurveError::TooFewEntries {
                count: entries.len(),
            });
        }
        let mut previous_nm = 0.0;
        for (index, &(nm, value)) in entries.iter().enumerate() {
            let entry = index + 1;
            if !(nm.is_finite() && nm > 0.0) {
                return Err(CurveError::InvalidWavelength { entry, nm });
            }
            if nm <= previous_nm {
                return Err(CurveError::NotIncreasing {
                    entry,
                    previous_nm,
                    nm,
                });
            }
            check(value, Place::Wavelength(nm))?;
            previous_nm = nm;
        }
        let nm: Box<[f32]> = entries.iter().map(|entry| entry.0).collect();
        Ok(match regular_step(&nm) {
            Some(step) => Self::Regular(RegularTable {
                first_nm: nm[0],
                last_nm: nm[nm.len() - 1],
                entries_per_nm: (1.0 / step) as f32,
                intervals: entries
                    .windows(2)
                    .map(|pair| Interval {
                        value: pair[0].1,
                        difference: pair[1].1 - pair[0].1,
                    })
                    .collect(),
            }),
            None => Self::Irregular(IrregularTable {
                nm,
                values: entries.iter().map(|entry| entry.1).collect(),
            }),
        })
    }

    /// The value at `nm`.
    #[inline]
    pub(super) fn at(&self, nm: f32) -> f32 {
        match self {
            Self::Regular(table) => table.evaluate(&[nm])[0],
            Self::Irregular(table) => table.at(nm),
        }
    }

    /// The one value that it has from `first_nm` to `last_nm`, if it has one.
    pub(super) fn flat_between(&self, first_nm: f32, last_nm: f32) -> Option<f32> {
        let (nm, is_flat) = match self {
            Self::Regular(table) => {
                let first = table.intervals[0].value;
                let is_flat =
                    |interval: &Interval| interval.value == first && interval.difference == 0.0;
                (
                    [table.first_nm, table.last_nm],
                    table.intervals.iter().all(is_flat),
                )
            }
            Self::Irregular(table) => {
                let first = table.values[0];
                let last = table.nm.len() - 1;
                let is_flat = table.values.iter().all(|&value| value == first);
                ([table.nm[0], table.nm[last]], is_flat)
            }
        };
        (is_flat && nm[0] <= first_nm && last_nm <= nm[1]).then(|| self.at(first_nm))
    }

    /// Whether it is zero at all wavelengths.
    pub(super) fn is_zero(&self) -> bool {
        match self {
            Self::Regular(table) => {
                let is_zero =
                    |interval: &Interval| interval.value == 0.0 && interval.difference == 0.0;
                table.intervals.iter().all(is_zero)
            }
            Self::Irregular(table) => table.values.iter().all(|&value| value == 0.0),
        }
    }
}

impl RegularTable {
    /// The value at each of the wavelengths `nm`.
    #[inline(always)]
    pub(super) fn evaluate<const N: usize>(&self, nm: &[f32; N]) -> [f32; N] {
        nm.map(|nm| {
            let position = (nm - self.first_nm) * self.entries_per_nm;
            let place = GridPlace::of(position, self.last_interval());
            let value = self.intervals[place.entry as usize].at(place.fraction);
            let is_inside = (nm >= self.first_nm) & (nm <= self.last_nm);
            if is_inside { value } else { 0.0 }
        })
    }

    /// Whether its entries stand at the wavelengths of those of `other`.
    #[inline(always)]
    pub(super) fn is_aligned_with(&self, other: &Self) -> bool {
        self.first_nm == other.first_nm
            && self.last_nm == other.last_nm
            && self.entries_per_nm == other.entries_per_nm
            && self.intervals.len() == other.intervals.len()
    }

    /// The number of the last interval.
    #[inline(always)]
    pub(super) fn last_interval(&self) -> f32 {
        (self.intervals.len() - 1) as f32
    }
}

impl IrregularTable {
    /// The value at `nm`.
    #[inline]
    pub(super) fn at(&self, nm: f32) -> f32 {
        let last = self.nm.len() - 1;
        if !(self.nm[0]..=self.nm[last]).contains(&nm) {
            return 0.0;
        }
        let entry = self.nm[1..last].partition_point(|&node| node <= nm);
        let (before, after) = (self.values[entry], self.values[entry + 1]);
        before + (nm - self.nm[entry]) / (self.nm[entry + 1] - self.nm[entry]) * (after - before)
    }
}

/// The distance of increasing wavelengths in nm, if they are equally far apart.
fn regular_step(nm: &[f32]) -> Option<f64> {
    let first = f64::from(nm[0]);
    let step = (f64::from(nm[nm.len() - 1]) - first) / (nm.len() - 1) as f64;
    let is_regular = nm.iter().enumerate().all(|(i, &nm)| {
        (f64::from(nm) - (first + i as f64 * step)).abs() <= REGULARITY_TOLERANCE * step
    });
    is_regular.then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(entries: &[(f32, f32)]) -> Result<PiecewiseLinear, CurveError> {
        PiecewiseLinear::new(entries, |_, _| Ok(()))
    }

    #[test]
    fn values_are_linear_between_the_entries_and_zero_outside() {
        let regular = table(&[(400.0, 1.0), (500.0, 3.0), (600.0, 0.0)]).unwrap();
        let irregular = table(&[(400.0, 1.0), (500.0, 3.0), (510.0, 2.0), (600.0, 0.5)]).unwrap();
        assert!(matches!(regular, PiecewiseLinear::Regular(_)));
        assert!(matches!(irregular, PiecewiseLinear::Irregular(_)));
        for (nm, value) in [
            (399.9, 0.0),
            (400.0, 1.0),
            (450.0, 2.0),
            (500.0, 3.0),
            (550.0, 1.5),
            (600.1, 0.0),
        ] {
            assert!((regular.at(nm) - value).abs() < 1e-5, "{nm} nm");
        }
        for (nm, value) in [
            (399.9, 0.0),
            (400.0, 1.0),
            (450.0, 2.0),
            (500.0, 3.0),
            (505.0, 2.5),
            (555.0, 1.25),
            (600.0, 0.5),
            (600.1, 0.0),
        ] {
            assert!((irregular.at(nm) - value).abs() < 1e-5, "{nm} nm");
        }
    }

    #[test]
    fn grids_of_decimal_fractions_are_regular() {
        let entries: Vec<_> = (0..101).map(|i| (380.0 + 3.9 * i as f32, 0.5)).collect();
        assert!(matches!(
            table(&entries).unwrap(),
            PiecewiseLinear::Regular(_)
        ));
    }

    #[test]
    fn every_entry_is_met_whatever_the_rounding() {
        for count in 2..200u16 {
            let nm = |i: u16| 360.0 + f32::from(i) * (470.0 / f32::from(count - 1));
            let entries: Vec<_> = (0..count)
                .map(|i| (nm(i), 1.0 + f32::from(i % 3)))
                .collect();
            let table = table(&entries).unwrap();
            assert!(
                entries
                    .iter()
                    .all(|&(nm, value)| (table.at(nm) - value).abs() < 1e-3),
                "{count}"
            );
        }
    }

    #[test]
    fn bad_lists_are_errors() {
        assert_eq!(table(&[]), Err(CurveError::TooFewEntries { count: 0 }));
        assert_eq!(
            table(&[(400.0, 1.0)]),
            Err(CurveError::TooFewEntries { count: 1 })
        );
        assert_eq!(
            table(&[(400.0, 1.0), (400.0, 1.0)]),
            Err(CurveError::NotIncreasing {
                entry: 2,
                previous_nm: 400.0,
                nm: 400.0
            })
        );
        assert!(matches!(
            table(&[(f32::NAN, 1.0), (400.0, 1.0)]),
            Err(CurveError::InvalidWavelength { entry: 1, .. })
        ));
        assert!(matches!(
            table(&[(4.0, 1.0), (f32::INFINITY, 1.0)]),
            Err(CurveError::InvalidWavelength { entry: 2, .. })
        ));
        assert!(matches!(
            table(&[(-4.0, 1.0), (400.0, 1.0)]),
            Err(CurveError::InvalidWavelength { .. })
        ));
    }
}
