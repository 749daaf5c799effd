//! Curves at the wavelengths of many paths at once.
//!
//! One path has too few wavelengths to fill a vector register. So the arithmetic of measured curves, which nearly all real
//! surfaces and lamps have, is one loop over all wavelengths of all paths.

use super::curve::SpectralCurve;
use super::piecewise_linear::{GridPlace, RegularTable};
use super::values::Spectrum;
use super::wavelengths::Wavelengths;

/// Paths that are taken together.
const LANES: usize = 16;

/// Hands the value of every curve at the wavelengths beside it to `take`, in their order.
#[inline(always)]
pub(super) fn evaluate_each<'a, const N: usize>(
    mut colours: impl Iterator<Item = (&'a SpectralCurve, &'a Wavelengths<N>)>,
    mut take: impl FnMut(Spectrum<N>),
) {
    let mut places = GridPlaces::<N>::new();
    let mut asked = [None; LANES];
    loop {
        let mut count = 0;
        for (place, (curve, wavelengths)) in asked.iter_mut().zip(colours.by_ref()) {
            let table = curve.regular_table();
            if let Some(table) = table {
                places.ask(count, table, wavelengths);
            }
            *place = Some((curve, wavelengths, table));
            count += 1;
        }
        places.find();
        for (lane, asked) in asked[..count].iter().enumerate() {
            if let Some((curve, wavelengths, table)) = asked {
                take(match table {
                    Some(table) => Spectrum(places.values(lane, table)),
                    None => curve.evaluate(wavelengths),
                });
            }
        }
        if count < LANES {
            return;
        }
    }
}

/// Appends the values of all `curves` at each of the `wavelengths` to `values`: those at the same ones side by side.
#[inline(always)]
pub(super) fn evaluate_all<const N: usize>(
    curves: &[SpectralCurve],
    wavelengths: &[Wavelengths<N>],
    values: &mut Vec<Spectrum<N>>,
) {
    let mut places = GridPlaces::<N>::new();
    for wavelengths in wavelengths.chunks(LANES) {
        let start = values.len();
        values.resize(start + wavelengths.len() * curves.len(), Spectrum([0.0; N]));
        let values = &mut values[start..];
        for (nm, wavelengths) in places.nm.iter_mut().zip(wavelengths) {
            *nm = *wavelengths.nm();
        }
        let mut found = None;
        for (number, curve) in curves.iter().enumerate() {
            let of_curve = values.iter_mut().skip(number).step_by(curves.len());
            match curve.regular_table() {
                Some(table) => {
                    // Measured curves are often given at the same wavelengths.
                    if !found.is_some_and(|found| table.is_aligned_with(found)) {
                        places.find_in(table);
                        found = Some(table);
                    }
                    for (lane, value) in of_curve.enumerate() {
                        *value = Spectrum(places.values(lane, table));
                    }
                }
                None => {
                    for (value, wavelengths) in of_curve.zip(wavelengths) {
                        *value = curve.evaluate(wavelengths);
                    }
                }
            }
        }
    }
}

/// Where wavelengths lie in the tables of their lanes.
#[repr(align(64))]
struct GridPlaces<const N: usize> {
    nm: [[f32; N]; LANES],
    first_nm: [[f32; N]; LANES],
    last_nm: [[f32; N]; LANES],
    entries_per_nm: [[f32; N]; LANES],
    last_interval: [[f32; N]; LANES],
    interval: [[u32; N]; LANES],
    fraction: [[f32; N]; LANES],
    /// All bits inside of the table, none outside.
    inside: [[u32; N]; LANES],
}

impl<const N: usize> GridPlaces<N> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            nm: [[0.0; N]; LANES],
            first_nm: [[0.0; N]; LANES],
            last_nm: [[0.0; N]; LANES],
            entries_per_nm: [[0.0; N]; LANES],
            last_interval: [[0.0; N]; LANES],
            interval: [[0; N]; LANES],
            fraction: [[0.0; N]; LANES],
            inside: [[0; N]; LANES],
        }
    }

    /// Has the places of `wavelengths` in `table` found by [`Self::find`].
    #[inline(always)]
    fn ask(&mut self, lane: usize, table: &RegularTable, wavelengths: &Wavelengths<N>) {
        self.nm[lane] = *wavelengths.nm();
        self.first_nm[lane] = [table.first_nm; N];
        self.last_nm[lane] = [table.last_nm; N];
        self.entries_per_nm[lane] = [table.entries_per_nm; N];
        self.last_interval[lane] = [table.last_interval(); N];
    }

    /// Finds the places of all `nm` in the same `table`.
    #[inline(always)]
    fn find_in(&mut self, table: &RegularTable) {
        self.first_nm = [[table.first_nm; N]; LANES];
        self.last_nm = [[table.last_nm; N]; LANES];
        self.entries_per_nm = [[table.entries_per_nm; N]; LANES];
        self.last_interval = [[table.last_interval(); N]; LANES];
        self.find();
    }

    /// Finds all that was asked for.
    #[inline(always)]
    fn find(&mut self) {
        let (nm, first_nm) = (self.nm.as_flattened(), self.first_nm.as_flattened());
        let (last_nm, per_nm) = (
            self.last_nm.as_flattened(),
            self.entries_per_nm.as_flattened(),
        );
        let last_interval = self.last_interval.as_flattened();
        let interval = self.interval.as_flattened_mut();
        let fraction = self.fraction.as_flattened_mut();
        let inside = self.inside.as_flattened_mut();
        for i in 0..N * LANES {
            let place = GridPlace::of((nm[i] - first_nm[i]) * per_nm[i], last_interval[i]);
            interval[i] = place.entry;
            fraction[i] = place.fraction;
            let is_inside = (nm[i] >= first_nm[i]) & (nm[i] <= last_nm[i]);
            inside[i] = u32::from(is_inside).wrapping_neg();
        }
    }

    /// The values of `table`, the one asked for in this lane.
    #[inline(always)]
    fn values(&self, lane: usize, table: &RegularTable) -> [f32; N] {
        let (interval, fraction) = (&self.interval[lane], &self.fraction[lane]);
        std::array::from_fn(|i| {
            let value = table.intervals[interval[i] as usize].at(fraction[i]);
            f32::from_bits(value.to_bits() & self.inside[lane][i])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_curves_have_the_values_of_each() {
        let entries: Vec<_> = (0..31)
            .map(|i| (400.0 + 10.0 * i as f32, 0.03 * (i % 7) as f32))
            .collect();
        let kinds = [
            SpectralCurve::tabulated_reflectance(&entries).unwrap(),
            SpectralCurve::tabulated_reflectance(&[(360.0, 1.0), (830.0, 0.0)]).unwrap(),
            SpectralCurve::tabulated_reflectance(&[(500.0, 0.1), (510.0, 0.9), (600.0, 0.3)])
                .unwrap(),
            SpectralCurve::constant_reflectance(0.25).unwrap(),
            SpectralCurve::rgb_reflectance([0.1, 0.5, 0.7]).unwrap(),
            SpectralCurve::tabulated_emission(&[(400.0, 0.0), (500.0, 8.0), (600.0, 15.6)])
                .unwrap(),
        ];
        for count in [0, 1, LANES, 57] {
            let curves: Vec<_> = kinds.iter().cycle().take(count).collect();
            let wavelengths: Vec<_> = (0..count)
                .map(|i| Wavelengths::<4>::sample(i as f32 / 57.0))
                .collect();
            let colours = || curves.iter().copied().zip(&wavelengths);
            let mut values = Vec::new();
            evaluate_each(colours(), |value| values.push(value));
            let expected: Vec<_> = colours().map(|(curve, at)| curve.evaluate(at)).collect();
            assert_eq!(values, expected);

            values.clear();
            evaluate_all(&kinds, &wavelengths, &mut values);
            let of_path = |at| kinds.iter().map(move |curve| curve.evaluate(at));
            let expected: Vec<_> = wavelengths.iter().flat_map(of_path).collect();
            assert_eq!(values, expected);
        }
    }

    #[test]
    fn the_ends_of_a_table_belong_to_it() {
        let curve = SpectralCurve::tabulated_reflectance(&[(400.0, 0.5), (500.0, 0.75)]).unwrap();
        let wavelengths = Wavelengths::at([399.9, 400.0, 500.0, 500.1]);
        let mut values = Vec::new();
        evaluate_each([(&curve, &wavelengths)].into_iter(), |value| {
            values.push(value);
        });
        assert_eq!(values, [Spectrum([0.0, 0.5, 0.75, 0.0])]);
    }
}
