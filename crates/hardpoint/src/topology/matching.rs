//! Assignment of rows to the unknowns that they determine.

use crate::order::sort_by_index;

/// Computes a maximum matching of columns and rows that contain them; returns the row of each column.
///
/// Hopcroft and Karp's algorithm. First every row takes a free column, rows with the fewest columns first and then in
/// the given order; chains of loops need no more. Then the remaining columns displace others along shortest paths.
/// Takes O(entries * sqrt(columns)) time, without recursion.
pub(super) fn match_columns(rows: &[Vec<usize>], columns: usize) -> Vec<Option<usize>> {
    let mut rows_of = vec![Vec::new(); columns];
    for (r, row) in rows.iter().enumerate() {
        for &c in row {
            rows_of[c].push(r);
        }
    }
    let mut row_of: Vec<Option<usize>> = vec![None; columns];
    let mut column_of: Vec<Option<usize>> = vec![None; rows.len()];
    let mut order: Vec<usize> = (0..rows.len()).collect();
    sort_by_index(&mut order, |r| rows[*r].len());
    for r in order {
        if let Some(&c) = rows[r].iter().find(|&&c| row_of[c].is_none()) {
            (row_of[c], column_of[r]) = (Some(r), Some(c));
        }
    }
    const FAR: usize = usize::MAX;
    loop {
        // Level of a column: number of displacements from a column without a row.
        let mut level: Vec<usize> = row_of.iter().map(|r| if r.is_none() { 0 } else { FAR }).collect();
        let mut queue: Vec<usize> = (0..columns).filter(|&c| level[c] == 0).collect();
        let free = queue.clone();
        let mut next = 0;
        while next < queue.len() {
            let c = queue[next];
            next += 1;
            for mate in rows_of[c].iter().filter_map(|&r| column_of[r]) {
                if level[mate] == FAR {
                    level[mate] = level[c] + 1;
                    queue.push(mate);
                }
            }
        }
        let mut tried = vec![0; columns];
        let mut found = false;
        for start in free {
            let mut path = vec![start];
            while let Some(&c) = path.last() {
                let Some(&r) = rows_of[c].get(tried[c]) else {
                    path.pop();
                    continue;
                };
                tried[c] += 1;
                match column_of[r] {
                    Some(mate) if level[mate] == level[c] + 1 => path.push(mate),
                    Some(_) => {}
                    None => {
                        for c in path.drain(..).rev() {
                            let r = rows_of[c][tried[c] - 1];
                            (row_of[c], column_of[r]) = (Some(r), Some(c));
                        }
                        found = true;
                    }
                }
            }
        }
        if !found {
            return row_of;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matched(rows: &[Vec<usize>], columns: usize) -> usize {
        let row_of = match_columns(rows, columns);
        let mut used = vec![false; rows.len()];
        for (c, r) in row_of.iter().enumerate().filter_map(|(c, r)| Some((c, (*r)?))) {
            assert!(rows[r].contains(&c) && !used[r], "column {c} has row {r}");
            used[r] = true;
        }
        used.iter().filter(|u| **u).count()
    }

    #[test]
    fn a_greedy_choice_is_undone_where_another_column_needs_the_row() {
        // Rows 0 and 1 both take the only column of row 2.
        assert_eq!(matched(&[vec![0, 1], vec![1, 2], vec![0, 2]], 3), 3);
        assert_eq!(matched(&[vec![0, 1, 2], vec![0, 1], vec![0, 1]], 3), 3);
        assert_eq!(matched(&[vec![0], vec![0], vec![0, 1]], 3), 2);
    }

    #[test]
    fn matching_is_maximum_by_exhaustive_search() {
        // All bipartite graphs of three rows over three columns.
        for bits in 0..512_u32 {
            let rows: Vec<Vec<usize>> =
                (0..3).map(|r| (0..3).filter(|c| bits >> (3 * r + c) & 1 == 1).collect()).collect();
            let mut most = 0;
            for a in [None, Some(0), Some(1), Some(2)] {
                for b in [None, Some(0), Some(1), Some(2)] {
                    for c in [None, Some(0), Some(1), Some(2)] {
                        let pick = [a, b, c];
                        let valid = (0..3).all(|r| {
                            pick[r].is_none_or(|x| rows[r].contains(&x) && (0..r).all(|s| pick[s] != pick[r]))
                        });
                        if valid {
                            most = most.max(pick.iter().flatten().count());
                        }
                    }
                }
            }
            assert_eq!(matched(&rows, 3), most, "{rows:?}");
        }
    }

    #[test]
    fn a_long_path_of_displacements_needs_no_deep_stack() {
        // Row k can take k or k + 1, and prefers k + 1; the last row can take the last column only.
        let n = 100_000;
        let rows: Vec<Vec<usize>> =
            (0..n).map(|k| if k + 1 < n { vec![k + 1, k] } else { vec![k, k] }).collect();
        assert_eq!(matched(&rows, n), n);
    }
}
