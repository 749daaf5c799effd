//! Lists that are filled anew for every batch.

/// How many entries there is to be room for where `count` are wanted.
fn with_room(count: usize) -> usize {
    (count + count / 4).next_power_of_two()
}

/// Empties `list` and makes room for `count` entries.
///
/// Batches differ a little in size. Room is made for a quarter more and up to the next power of two, so that the first batch
/// makes it for those that follow.
pub(crate) fn make_room<T>(list: &mut Vec<T>, count: usize) {
    list.clear();
    list.reserve(with_room(count));
}

/// Makes `list` `count` entries long, whatever they are, with the same room.
pub(crate) fn resize<T: Clone + Default>(list: &mut Vec<T>, count: usize) {
    list.reserve(with_room(count).saturating_sub(list.len()));
    list.resize(count, T::default());
}

/// `list` becomes `source` in another order, number `order[i]` in place i; or nothing, if `source` is.
pub(crate) fn gather<T: Copy>(list: &mut Vec<T>, source: &[T], order: &[u32]) {
    list.clear();
    if !source.is_empty() {
        list.reserve(with_room(order.len()));
        list.extend(order.iter().map(|&i| source[i as usize]));
    }
}
