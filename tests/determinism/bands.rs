//! Bands are the quantiles over time of the runs, and depend on nothing but the plan.

use crate::prelude::*;
use crate::support::plans::{SOMETIMES_IMPOSSIBLE, shipped_with};
use std::sync::atomic::AtomicUsize;

use spindrift::ensemble::Bands;
use spindrift::statistics::deviation::RELATIVE_ERROR;
use spindrift::storage::bands_file::{self, BandsFile};
use spindrift::storage::disk::folder;

const SAMPLES: u64 = 700;

fn plan(points: usize) -> Plan {
    let more = format!("{SOMETIMES_IMPOSSIBLE}\n[bands]\npoints = {points}\n");
    let mut plan = shipped_with("spin_sweep", Some(SAMPLES), &more);
    plan.groups = Group::ALL.to_vec();
    plan
}

fn files(plan: &Plan, threads: usize) -> Vec<Vec<u8>> {
    files_of(plan, Parts::of(plan.samples), threads)
}

fn files_of(plan: &Plan, parts: Parts, threads: usize) -> Vec<Vec<u8>> {
    let (files, ensemble) = (Mutex::new(BTreeMap::new()), Ensemble::new(plan, Isa::best()));
    let sink = |rows: &Rows| {
        let bands = rows.bands().ok_or("rows without bands")?;
        let mut bytes = Vec::new();
        let file = BandsFile::new(bands.layout()).map_err(|error| error.to_string())?;
        file.write(rows.part(), bands, &mut bytes).map_err(|error| error.to_string())?;
        let mut whole = Bands::new(bands.layout().clone());
        whole.add(bands);
        assert!(merged([&bytes]) == whole, "what is written is read back");
        files.lock().unwrap().insert(rows.part().id.0, bytes);
        Ok::<(), String>(())
    };
    run(&ensemble, parts, NonZeroUsize::new(threads), &sink, Supervision::progress(&|_| {})).unwrap();
    files.into_inner().unwrap().into_values().collect()
}

fn merged<'a>(files: impl IntoIterator<Item = &'a Vec<u8>>) -> Bands {
    static FOLDERS: AtomicUsize = AtomicUsize::new(0);
    let scratch = ScratchFolder::new(&format!("bands-{}", FOLDERS.fetch_add(1, Ordering::Relaxed)));
    let written = files.into_iter().zip(0..).map(|(bytes, number)| {
        let name = format!("part-{number:06}.parquet");
        std::fs::write(scratch.path(&name), bytes).unwrap();
        name
    });
    bands_file::read(&*folder(&scratch.0), &written.collect::<Vec<_>>(), None).unwrap().unwrap()
}

fn exact(plan: &Plan, points: &[usize]) -> BTreeMap<String, Vec<Vec<f64>>> {
    let isa = Isa::best();
    let simulated = |sample: u64| SingleRun::new(plan, SampleId(sample), plan.grid.clone(), isa);
    let nominal = simulated(0).unwrap();
    let mut observer = Observer::new(nominal.request, &plan.grid)
        .with_nominal(Some(NominalAttitude::of(&nominal.table, &nominal.outcome)));
    let mut row = vec![0.0; nominal.request.columns().len()];
    let mut found: BTreeMap<String, Vec<Vec<f64>>> = BTreeMap::new();
    for run in (0..SAMPLES).filter_map(|sample| simulated(sample).ok()) {
        assert_eq!(run.outcome.status, Status::Done);
        observer.observe(isa, &run.scene, &run.table, &run.outcome, &mut row);
        for (series, values) in observer.series() {
            let name = series.quantity(&nominal.request.wheels).unwrap().name().to_owned();
            let all: Vec<f64> = values.collect();
            let is_com = (0..2).map(|wheel| Series::ComWheel.of_wheel(wheel)).any(|wheel| wheel == series);
            if is_com || series == Series::ComBody {
                let change = points.iter().map(|point| all[*point] - all[0]).collect();
                found.entry(name.replace("energy_com", "exchange")).or_default().push(change);
            }
            found.entry(name).or_default().push(points.iter().map(|point| all[*point]).collect());
        }
    }
    found
}

fn deviations(bands: &Bands, exact: &BTreeMap<String, Vec<Vec<f64>>>) -> Vec<String> {
    /// An angle is kept as the tangent of its half.
    const ROUNDING: f64 = 16.0 * f64::EPSILON;
    let mut wrong = Vec::new();
    for series in 0..bands.layout().series.len() {
        let name = bands.quantity(series).name();
        let [nominal, runs @ ..] = &exact[name][..] else { panic!("no runs of {name}") };
        for (point, nominal) in nominal.iter().enumerate() {
            let mut values: Vec<f64> = runs.iter().map(|run| run[point]).collect();
            values.sort_by(f64::total_cmp);
            let near = |found: f64, value: f64| (found - value).abs() <= ROUNDING * value.abs();
            let [min, max] = bands.extremes(series, point).unwrap();
            let is_exact = bands.count(series, point) == values.len() as u64
                && bands.nominal(series, point).is_some_and(|found| near(found, *nominal))
                && near(min, values[0])
                && near(max, values[values.len() - 1]);
            if !is_exact {
                wrong.push(format!("{name} at point {point}: count, nominal or extremes"));
            }
            for p in [0.0, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 1.0] {
                let (found, expected) = (bands.quantile(series, point, p).unwrap(), quantile(&values, p).unwrap());
                let below = (p * (values.len() - 1) as f64) as usize;
                let neighbours = [values[below], values[(below + 1).min(values.len() - 1)]];
                let largest = neighbours.map(|value| (value - nominal).abs()).into_iter().fold(0.0, f64::max);
                let bound = RELATIVE_ERROR * largest + ROUNDING * (expected.abs() + nominal.abs());
                if (found - expected).abs() > bound {
                    wrong.push(format!("{name} at point {point}, {p}: {found} for {expected}"));
                }
            }
        }
    }
    wrong
}

#[test]
fn bands_are_the_quantiles_of_the_runs() {
    let plan = plan(9);
    let points = plan.grid.evenly(9);
    assert_eq!(points, [0, 13, 25, 38, 50, 63, 75, 88, 100]);
    let bands = merged(&files(&plan, 2));
    assert_eq!(bands.layout().series.len(), 15);
    let exact = exact(&plan, &points);
    let runs = exact["energy_error"].len() as u64 - 1;
    assert!(runs < SAMPLES - 100, "some samples are impossible: {runs} runs");
    assert_eq!(bands.runs(), runs);
    let wrong = deviations(&bands, &exact);
    assert!(wrong.is_empty(), "{}: {wrong:#?}", wrong.len());
    let body = bands.find("energy_body_j").unwrap();
    let [low, high] = [0.05, 0.95].map(|p| bands.quantile(body, 5, p).unwrap());
    assert!(high - low > 100.0 * RELATIVE_ERROR * (high - bands.nominal(body, 5).unwrap()).abs());
}

#[test]
fn the_angular_rate_has_bands() {
    let rate = |groups: &[Group]| {
        let mut plan = plan(9);
        plan.groups = groups.to_vec();
        let bands = merged(&files(&plan, 1));
        let series = bands.find("angular_rate_rad_s").unwrap();
        let numbers = |point: usize| {
            let quantiles = [0.05, 0.5, 0.95].map(|p| bands.quantile(series, point, p).unwrap());
            (bands.count(series, point), bands.extremes(series, point).unwrap(), quantiles)
        };
        (0..9).map(numbers).collect::<Vec<_>>()
    };
    let (own, observed) = (rate(&Group::DEFAULT), rate(&[Group::Motion]));
    assert!(!Group::DEFAULT.contains(&Group::Motion));
    for ((count, extremes, quantiles), (counts, exact, expected)) in own.iter().zip(&observed) {
        assert_eq!(count, counts);
        for (found, expected) in extremes.iter().zip(exact) {
            assert!((found - expected).abs() <= 2.0 * f64::EPSILON * expected, "{found} {expected}");
        }
        for (found, expected) in quantiles.iter().zip(expected) {
            let bound = 2.0 * RELATIVE_ERROR * (extremes[1] - extremes[0]);
            assert!((found - expected).abs() <= bound, "{found} {expected}");
        }
    }
    assert!(own[8].1[1] > 1.1 * own[8].1[0]);
}

#[test]
fn no_bands_where_none_are_asked_for() {
    let mut plan = plan(0);
    assert!(Ensemble::new(&plan, Isa::best()).bands().is_none());
    plan.band_points = 3;
    assert!(Ensemble::new(&plan, Isa::best()).bands().is_some());
    plan.groups = vec![Group::StepStatistics];
    assert!(Ensemble::new(&plan, Isa::best()).bands().is_none());
}

#[test]
fn quantiles_of_a_large_campaign_are_those_of_its_first_runs() {
    const RUNS: u64 = 1000;
    const ALL: u64 = 4000;
    let text = plan(5).text();
    let plan = |samples: u64, runs: u64| {
        let text = text.replace("points = 5\n", &format!("points = 5\nruns = {runs}\n"));
        let overrides = Overrides { samples: Some(samples), ..Overrides::default() };
        let plan = Plan::from_text("bands", &text, overrides).unwrap();
        assert_eq!((plan.band_runs, plan.last_counted()), (runs, SampleId(runs)));
        plan
    };
    let (thinned, first, all) = (plan(ALL, RUNS), plan(RUNS + 1, RUNS), plan(ALL, ALL));
    let found = merged(&files(&thinned, 1));
    assert!(found == merged(&files(&thinned, 2)), "threads");
    assert!(found == merged(&files_of(&thinned, Parts::up_to(ALL, 77), 1)), "parts");
    let [first, all] = [first, all].map(|plan| merged(&files(&plan, 1)));
    assert_eq!((found.runs(), found.counted_runs()), (all.runs(), first.runs()));
    assert_eq!(all.counted_runs(), all.runs());
    let (mut others, mut places, mut undecided) = (0, 0, 0);
    for (series, point) in (0..found.layout().series.len()).flat_map(|series| (0..5).map(move |point| (series, point)))
    {
        let [of_found, of_all] =
            [&found, &all].map(|bands| (bands.count(series, point), bands.extremes(series, point)));
        assert_eq!(of_found, of_all);
        assert_eq!(found.counted(series, point), first.count(series, point));
        for p in [0.05, 0.5, 0.95] {
            let [value, of_first, of_all] =
                [&found, &first, &all].map(|bands| bands.quantile(series, point, p).unwrap());
            let [min, max] = first.extremes(series, point).unwrap();
            assert!(value == of_first || value < min || value > max, "{value} {of_first}");
            others += u64::from(value != of_all);
            places += 1;
            let limit = GateLimit::AtMost(value);
            let ([least, most], [least_of_all, most_of_all]) =
                (found.within(series, point, limit), all.within(series, point, limit));
            assert!(least <= least_of_all && most_of_all <= most, "{least} {least_of_all} {most_of_all} {most}");
            undecided += u64::from(most - least >= found.count(series, point) - found.counted(series, point));
            let [_, above] = all.within(series, point, GateLimit::AtLeast(value));
            let (count, error) = (all.count(series, point) as f64, (p * (1.0 - p) / RUNS as f64).sqrt());
            let [below, not_above] = [count - above as f64, most_of_all as f64].map(|runs| runs / count);
            assert!(below - 5.0 * error <= p && p <= not_above + 5.0 * error, "{p}: {below} {not_above}");
        }
    }
    assert!(others > places / 2, "{others} of {places}");
    assert!(undecided > places / 2, "{undecided} of {places}");
}

#[test]
fn all_runs_of_a_grid_are_counted() {
    let text = campaign_text("no_debris");
    let last = |design: &str| {
        let text = format!("{text}\n[design]\nkind = \"{design}\"\n");
        parsed(&text).map(|plan| plan.last_counted().0)
    };
    for design in ["random", "latin_hypercube", "sobol", "halton"] {
        assert_eq!(last(design).unwrap(), 131_072, "{design}");
    }
    let plan = planned(&text);
    assert_eq!(plan.only(vec![0, 5, 9]).unwrap().last_counted().0, u64::MAX);
}
