//! Lists that are filled anew for every batch.

/// Empties `list` and makes room for `count` entries.
///
/// Batches differ a little in size. Room is made for the next power of two, so that the first batch makes it for those
/// that follow.
pub(crate) fn make_room<T>(list: &mut Vec<T>, count: usize) {
    list.clear();
    list.reserve(count.next_power_of_two());
}
