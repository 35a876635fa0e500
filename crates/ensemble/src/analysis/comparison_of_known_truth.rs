//! Comparisons of campaigns of known truth.

use crate::analysis::comparison::of_both;
use crate::analysis::known_truth::{comparison, rows};
use crate::statistics::moments::Moments;
use crate::statistics::two_sample::paired;

/// H0: nothing differs but noise or the seed. Any of three observables is called shifted, moved, or changed in its
/// share without a value in at most 0.05 of campaigns each: of seeds 1 to 300, at most 26 (alpha = 2e-3 for each of
/// 12).
#[test]
fn what_does_not_differ_is_seldom_said_to() {
    for (noise, are_pairs) in [(0.1, true), (1.0, true), (0.0, false)] {
        let mut counts = [0; 3];
        for seed in 1..=300 {
            let other = if are_pairs { seed } else { seed + 1000 };
            let both = [rows(200, [seed, seed + 2000], noise, 0.1), rows(200, [other, seed + 3000], noise, 0.1)];
            let found = comparison(both.each_ref().map(Vec::as_slice), are_pairs);
            let any = [
                found.columns.iter().any(|column| found.is_shifted(column)),
                found.columns.iter().any(|column| found.is_moved(column)),
                found.columns.iter().any(|column| found.is_changed(&column.absence)),
            ];
            counts.iter_mut().zip(any).for_each(|(count, any)| *count += u32::from(any));
        }
        println!("noise {noise}, pairs {are_pairs}: shifted, moved, changed {counts:?} of 300");
        assert!(counts.iter().all(|count| *count <= 26), "{noise} {are_pairs}: {counts:?}");
    }
    let one = rows(200, [1, 1], 0.0, 0.1);
    let found = comparison([&one, &one], true);
    assert!(found.columns.iter().all(|column| column.differing_pairs == 0 && !found.is_moved(column)));
}

/// Power, of 200 pairs with one seed in 60 campaigns: a shift of every run by 0.05 of the spread, a spread 1.1 times as
/// large, and missing values in 0.7 instead of 0.1 are always found; with other seeds the first two rarely.
#[test]
fn what_differs_is_found_by_pairs() {
    let changed =
        |rows: &[[f64; 3]]| -> Vec<[f64; 3]> { rows.iter().map(|[a, b, c]| [a + 0.05, 1.1 * b, *c]).collect() };
    let mut counts = [[0; 3]; 2];
    for seed in 1..=60 {
        let one = rows(200, [seed; 2], 0.0, 0.1);
        for (place, are_pairs) in [true, false].into_iter().enumerate() {
            let other = changed(&rows(200, [if are_pairs { seed } else { seed + 500 }; 2], 0.0, 0.7));
            let found = comparison([&one, &other], are_pairs);
            let column = |name: &str| found.columns.iter().find(|one| one.quantity.name() == name).expect("a column");
            let is_seen = |name: &str| found.is_moved(column(name)) || found.is_shifted(column(name));
            let all = [is_seen("a"), is_seen("b"), found.is_changed(&column("c").absence)];
            assert!(!are_pairs || !column("a").moves_apart());
            counts[place].iter_mut().zip(all).for_each(|(count, is)| *count += u32::from(is));
        }
    }
    println!("moved, spread, lost: pairs {:?}, other seeds {:?} of 60", counts[0], counts[1]);
    assert_eq!(counts[0], [60; 3]);
    let one = rows(200, [1; 2], 0.0, 0.0);
    let wider: Vec<[f64; 3]> = one.iter().map(|[a, b, c]| [1.05 * a, *b, *c]).collect();
    let found = comparison([&one, &wider], true);
    assert!(found.columns.iter().any(|column| column.quantity.name() == "a" && column.moves_apart()));
    assert!(counts[1][0] < 15 && counts[1][1] < 15 && counts[1][2] == 60, "{counts:?}");
}

/// Law: a test of means without spread does not decide.
#[test]
fn a_shift_without_spread_is_judged_by_the_other_test() {
    let certain = paired(&Moments::of_block(&[2.0; 3]), 0.95);
    assert_eq!(certain.map(|found| found.p_value), Some(0.0));
    assert_eq!((of_both(certain, Some(0.3)), of_both(certain, None), of_both(None, None)), (Some(0.3), None, None));
    let spread = paired(&Moments::of_block(&[1.0, 2.0, 3.0]), 0.95);
    assert_eq!(of_both(spread, Some(0.001)), Some(0.002));
}
