//! Sums over the squares about the pixels of an image.

use std::ops::AddAssign;

use crate::scene::ImageSize;

/// The sum of the `values` of every pixel and of those up to `reach` columns and rows away, of an image of `size`; pixels are in rows from the top.
///
/// # Panics
/// If there are not as many values as pixels.
pub fn neighbourhood_sums<T>(values: &[T], size: ImageSize, reach: usize) -> Vec<T>
where
    T: Copy + Default + AddAssign,
{
    let [width, height] = [size.width as usize, size.height as usize];
    assert_eq!(values.len(), width * height, "an image of another size");
    let mut rows = Vec::with_capacity(values.len());
    for row in values.chunks(width) {
        for x in 0..width {
            let near = x.saturating_sub(reach)..=(x + reach).min(width - 1);
            rows.push(sum(row[near].iter().copied()));
        }
    }
    let mut sums = Vec::with_capacity(values.len());
    for y in 0..height {
        let near = y.saturating_sub(reach)..=(y + reach).min(height - 1);
        for x in 0..width {
            sums.push(sum(near.clone().map(|y| rows[y * width + x])));
        }
    }
    sums
}

fn sum<T: Default + AddAssign>(values: impl Iterator<Item = T>) -> T {
    let mut sum = T::default();
    values.for_each(|value| sum += value);
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_end_at_the_border() {
        let size = ImageSize {
            width: 4,
            height: 3,
        };
        let values: Vec<u32> = (0..12).map(|i| 1 << i).collect();
        let sums = neighbourhood_sums(&values, size, 1);
        let of = |pixels: &[u32]| pixels.iter().map(|pixel| 1 << pixel).sum::<u32>();
        assert_eq!(sums[0], of(&[0, 1, 4, 5]));
        assert_eq!(sums[5], of(&[0, 1, 2, 4, 5, 6, 8, 9, 10]));
        assert_eq!(sums[11], of(&[6, 7, 10, 11]));
        assert_eq!(neighbourhood_sums(&values, size, 0), values);
        assert_eq!(
            neighbourhood_sums(&values, size, 9),
            [of(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]); 12]
        );
    }
}
