//! Sorting by keys. What sorts is compiled once, not for each type and each key.

/// Sorts items by numbers; those with equal numbers keep their order.
pub(crate) fn sort_by_number<T>(items: &mut [T], key: impl Fn(&T) -> f64) {
    let keys: Vec<f64> = items.iter().map(key).collect();
    arrange(items, places_by_number(&keys));
}

/// Sorts items by indices; those with equal indices keep their order.
pub(crate) fn sort_by_index<T>(items: &mut [T], key: impl Fn(&T) -> usize) {
    let keys: Vec<usize> = items.iter().map(key).collect();
    arrange(items, places_by_index(&keys));
}

/// Places of the keys in their order.
fn places_by_number(keys: &[f64]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..keys.len()).collect();
    places.sort_by(|a, b| keys[*a].total_cmp(&keys[*b]));
    places
}

fn places_by_index(keys: &[usize]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..keys.len()).collect();
    places.sort_by_key(|k| keys[*k]);
    places
}

/// Moves each item from its place in `places` to that place's position in the list.
fn arrange<T>(items: &mut [T], mut places: Vec<usize>) {
    for start in 0..items.len() {
        // Around the cycle that this place is on, which is done then
        let mut k = start;
        while places[k] != start {
            let from = places[k];
            items.swap(k, from);
            places[k] = k;
            k = from;
        }
        places[k] = k;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_in_the_order_of_their_keys_and_equal_keys_keep_theirs() {
        // All sequences of five keys of 0 to 4
        for code in 0..5usize.pow(5) {
            let keys: Vec<usize> = (0..5).map(|k| code / 5usize.pow(k) % 5).collect();
            let mut sorted: Vec<_> = keys.iter().copied().enumerate().collect();
            sorted.sort_by_key(|(_, key)| *key);
            let mut items: Vec<_> = keys.iter().copied().enumerate().collect();
            let mut numbered = items.clone();
            sort_by_index(&mut items, |(_, key)| *key);
            sort_by_number(&mut numbered, |(_, key)| *key as f64 - 2.0);
            assert_eq!(items, sorted);
            assert_eq!(numbered, sorted);
        }
    }
}
