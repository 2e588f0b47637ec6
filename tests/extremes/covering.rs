//! Few rows that hold every pair of ends: as all pairs of 2n ends are 2n(n − 1), and a row holds n(n − 1)/2 of them at
//! once, their number grows as log n only (D. M. Cohen et al., IEEE Trans. Softw. Eng. 23 (1997) 437).
//!
//! What is refused is learnt on the way: a row that may not be is cut down to the few ends that are to blame, and no later
//! row has them together.

use std::collections::HashSet;

use super::mixed;

/// Ends of a row: for each control the first, the second, or none.
pub(super) type Row = Vec<Option<usize>>;

/// Rows that are thought of, of which the one with most new pairs is taken.
const THOUGHT_OF: u64 = 12;

/// An end: which control, and which of both.
type End = (usize, usize);

/// What came of a covering.
pub(super) struct Covered {
    /// Rows that were tried with success.
    pub(super) rows: usize,
    /// Pairs that were in one of them.
    pub(super) pairs: usize,
    /// Ends, alone or together, that are refused: none of them can be left out.
    pub(super) refused: Vec<Vec<End>>,
    /// Pairs of which one end, or both together, are refused.
    pub(super) barred: usize,
}

/// Tries rows until each pair of ends of `controls` controls was in one that `may_be`, or is refused. One of `alone_of` controls
/// is left alone, for a row in which all is extreme often shows nothing. `is_refused` is asked of what is cut down to find whom
/// to blame.
pub(super) fn cover(
    controls: usize,
    alone_of: u64,
    mut may_be: impl FnMut(&Row) -> bool,
    mut is_refused: impl FnMut(&Row) -> bool,
) -> Covered {
    let mut open: HashSet<[End; 2]> = (0..controls)
        .flat_map(|a| (a + 1..controls).map(move |b| (a, b)))
        .flat_map(|(a, b)| [[0, 0], [0, 1], [1, 0], [1, 1]].map(|[i, j]| [(a, i), (b, j)]))
        .collect();
    let mut covered = Covered {
        rows: 0,
        pairs: 0,
        refused: Vec::new(),
        barred: 0,
    };
    let mut tries = 0;
    // In an order of their own: a set's differs from run to run.
    while let Some(&seed) = open.iter().min() {
        let thought_of = (0..THOUGHT_OF).map(|i| {
            let number = THOUGHT_OF * tries + i;
            let row = row((controls, alone_of), seed, &open, &covered.refused, number);
            (pairs(&row).filter(|pair| open.contains(pair)).count(), row)
        });
        let (_, row) = thought_of.max_by_key(|(new, _)| *new).expect("rows");
        tries += 1;
        if may_be(&row) {
            covered.rows += 1;
            let new = pairs(&row).filter(|pair| open.remove(pair)).count();
            covered.pairs += new;
        } else {
            let blamed = blamed(row, &mut is_refused);
            let before = open.len();
            open.retain(|pair| !blamed.iter().all(|end| pair.contains(end)));
            covered.barred += before - open.len();
            covered.refused.push(blamed);
        }
    }
    covered
}

/// A row around a pair: control by control the end that makes most open pairs with those before it.
fn row(
    (controls, alone_of): (usize, u64),
    seed: [End; 2],
    open: &HashSet<[End; 2]>,
    refused: &[Vec<End>],
    number: u64,
) -> Row {
    let mut row: Row = vec![None; controls];
    for (control, end) in seed {
        row[control] = Some(end);
    }
    let mut others: Vec<usize> = (0..controls).filter(|at| row[*at].is_none()).collect();
    others.sort_by_key(|&at| mixed(number << 16 | at as u64));
    for at in others {
        let random = mixed(!(number << 16 | at as u64));
        if random.is_multiple_of(alone_of) {
            continue;
        }
        let first = (random >> 32) as usize & 1;
        let new = |end: usize| {
            let made = ends(&row).map(|other| pair(other, (at, end)));
            made.filter(|pair| open.contains(pair)).count()
        };
        let likes = if new(1 - first) > new(first) {
            1 - first
        } else {
            first
        };
        let may = [likes, 1 - likes].into_iter().find(|&end| {
            row[at] = Some(end);
            !refused.iter().any(|blamed| holds(&row, blamed))
        });
        row[at] = may;
    }
    row
}

/// The ends of a refused row that are to blame: without any one of them it is not refused.
fn blamed(mut row: Row, is_refused: &mut impl FnMut(&Row) -> bool) -> Vec<End> {
    // Halves first, then smaller parts: most ends have nothing to do with it.
    let mut part = row.len().div_ceil(2);
    loop {
        for from in (0..row.len()).step_by(part) {
            let mut less = row.clone();
            let till = (from + part).min(row.len());
            less[from..till].fill(None);
            if less != row && is_refused(&less) {
                row = less;
            }
        }
        if part == 1 {
            break;
        }
        part = part.div_ceil(2);
    }
    let blamed: Vec<End> = ends(&row).collect();
    assert!(!blamed.is_empty(), "nothing set, and yet refused");
    blamed
}

fn ends(row: &Row) -> impl Iterator<Item = End> {
    let set = |(at, end): (usize, &Option<usize>)| end.map(|end| (at, end));
    row.iter().enumerate().filter_map(set)
}

fn holds(row: &Row, blamed: &[End]) -> bool {
    blamed.iter().all(|&(at, end)| row[at] == Some(end))
}

fn pair(a: End, b: End) -> [End; 2] {
    [a.min(b), a.max(b)]
}

fn pairs(row: &Row) -> impl Iterator<Item = [End; 2]> {
    let ends: Vec<End> = ends(row).collect();
    let of = move |i: usize| {
        let before = ends[..i].iter();
        before
            .map(|&other| pair(other, ends[i]))
            .collect::<Vec<_>>()
    };
    (0..row.iter().flatten().count()).flat_map(of)
}

/// Controls of the covering below.
const CONTROLS: usize = 40;

#[test]
fn few_rows_hold_every_pair_and_what_is_refused_is_found() {
    // Refused: one end alone, a pair, and three together.
    let bad: [&[End]; 3] = [&[(3, 1)], &[(5, 0), (9, 1)], &[(1, 0), (2, 0), (8, 0)]];
    let is_bad = |row: &Row| bad.iter().any(|blamed| holds(row, blamed));
    let mut held = HashSet::new();
    let covered = cover(
        CONTROLS,
        8,
        |row| {
            held.extend(pairs(row).filter(|_| !is_bad(row)));
            !is_bad(row)
        },
        is_bad,
    );
    let mut found = covered.refused.clone();
    found.sort();
    let mut expected: Vec<Vec<End>> = bad.map(<[End]>::to_vec).to_vec();
    expected.sort();
    for blamed in &expected[1..] {
        // Three together are found only if a row had them.
        assert!(found.contains(blamed) || blamed.len() > 2, "{found:?}");
    }
    let all = 2 * CONTROLS * (CONTROLS - 1);
    let barred = 2 * (CONTROLS - 1) + 1;
    assert_eq!((held.len(), covered.barred), (all - barred, barred));
    assert_eq!(covered.pairs, all - barred);
    assert!(covered.rows < 30, "{} rows", covered.rows);
}
