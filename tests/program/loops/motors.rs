//! Motors of a loop with failures and a schedule.

use crate::prelude::*;

const PERIOD: f64 = 0.5;
const GAIN: f64 = 0.1;
const LIMIT: f64 = 0.002;
const INERTIA: [f64; 2] = [6.0, 1e-3];
const DURATION: f64 = 10.0;
const ROUNDING: f64 = 1e-15;

#[derive(Clone, Copy, Debug)]
struct Case {
    rate: f64,
    scale: f64,
    bias: f64,
    coulomb: f64,
    scheduled: Option<[f64; 3]>,
    failed: Option<[f64; 2]>,
}

const PLAIN: Case = Case { rate: 0.1, scale: 1.0, bias: 0.0, coulomb: 0.0, scheduled: None, failed: None };

impl Case {
    fn text(&self) -> String {
        let Case { rate, scale, bias, coulomb, .. } = self;
        let scheduled = self.scheduled.map_or(String::new(), |[start, end, torque]| {
            format!("[[actuation]]\nstart_s = {start:?}\nend_s = {end:?}\ntorque_n_m = {{ w1 = {torque:?} }}\n")
        });
        let failed = self.failed.map_or(String::new(), |[time, factor]| {
            format!("[[failure]]\nname = \"weak\"\nwheel = \"w1\"\nat_s = {time:?}\ntorque_scale = {factor:?}\n")
        });
        format!(
            "[campaign]\nname = \"m\"\nsamples = 2\nseed = 1\nduration_s = {DURATION:?}\n[observe]\npoints = 3\n\
             groups = [\"final_state\", \"motion\", \"numerics\"]\n\
             [body]\nmass_kg = 100.0\nprincipal_moments_kg_m2 = [8.0, 9.0, {:?}]\nincludes_wheels = true\n\
             [[wheels]]\nname = \"w1\"\naxis = [0, 0, 1]\nmass_kg = 1.0\naxial_inertia_kg_m2 = {:?}\n\
             transverse_inertia_kg_m2 = 6e-4\nrate_rad_s = 50.0\ntorque_limit_n_m = {LIMIT:?}\n\
             torque_scale = {scale:?}\ntorque_bias_n_m = {bias:?}\ncoulomb_friction_n_m = {coulomb:?}\n\
             [initial]\nangular_velocity_rad_s = [0, 0, {rate:?}]\n\
             [control]\nperiod_s = {PERIOD:?}\nwheels = [\"w1\"]\n\
             [[guidance]]\nphase = \"a\"\nlaw = \"rate_damping\"\ngain_n_m_s = {GAIN:?}\n{scheduled}{failed}",
            INERTIA[0], INERTIA[1]
        )
    }

    fn instants(&self) -> Vec<f64> {
        let mut all: Vec<f64> = (0..=20).map(|tick| f64::from(tick) * PERIOD).collect();
        all.extend(self.scheduled.iter().flat_map(|[start, end, _]| [*start, *end]));
        all.extend(self.failed.iter().map(|[time, _]| *time));
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    fn simulated(&self) -> Vec<(f64, f64, bool)> {
        let (mut rate, mut commanded, mut list) = (self.rate, 0.0, Vec::new());
        for arc in self.instants().windows(2) {
            if (arc[0] / PERIOD).fract() == 0.0 {
                commanded = GAIN * rate;
            }
            let scheduled = self.scheduled.filter(|[start, end, _]| *start <= arc[0] && arc[0] < *end);
            let total = commanded + scheduled.map_or(0.0, |[.., torque]| torque);
            let asked = if total == 0.0 { 0.0 } else { self.scale * total + self.bias };
            let factor = self.failed.filter(|[time, _]| *time <= arc[0]).map_or(1.0, |[_, factor]| factor);
            let motor = factor * asked.clamp(-LIMIT, LIMIT);
            let on_wheel = motor - self.coulomb;
            list.push((rate, on_wheel, asked.abs() > LIMIT));
            rate -= on_wheel * (arc[1] - arc[0]) / (INERTIA[0] - INERTIA[1]);
        }
        list
    }
}

#[test]
fn motors_give_what_schedules_and_failures_leave() {
    let biased = Case { rate: 0.001, bias: 1e-4, ..PLAIN };
    let both =
        Case { rate: 0.01, scale: 0.9, bias: -2e-4, coulomb: 1e-4, scheduled: Some([2.2, 6.8, 0.0015]), ..PLAIN };
    let mut met = [0; 2];
    for case in [
        PLAIN,
        Case { failed: Some([5.0, 0.5]), ..PLAIN },
        Case { failed: Some([3.2, -0.5]), ..PLAIN },
        Case { failed: Some([3.2, 0.0]), rate: 0.01, ..PLAIN },
        Case { scheduled: Some([5.0, 8.0, 0.004]), ..biased },
        Case { scheduled: Some([5.2, 7.9, 5e-4]), ..biased },
        Case { scheduled: Some([5.2, 7.9, -1e-3]), failed: Some([6.1, 0.5]), ..biased },
        both,
        Case { failed: Some([4.0, 0.75]), ..both },
    ] {
        let instants = case.instants();
        let plan = plan(&case.text());
        let run = single_on(&plan, 0, Grid::at(instants.clone()));
        let torques = &run.series.iter().find(|(series, _)| *series == Series::MotorTorque.of_wheel(0)).unwrap().1;
        let mut saturated = 0.0;
        assert_eq!(run.arcs.len(), instants.len() - 1, "{case:?}: {:?}", run.arcs);
        for (place, (rate, on_wheel, is_cut)) in case.simulated().into_iter().enumerate() {
            let found: [f64; 3] = run.table.at(StateField::Rate, place);
            assert!((found[2] - rate).abs() < ROUNDING, "{case:?} at {}: {found:?} for {rate}", instants[place]);
            for shown in [torques[place], run.arcs[place].applied.motor_torque[0]] {
                assert!((shown - on_wheel).abs() < ROUNDING, "{case:?} at {}: {shown}", instants[place]);
            }
            saturated += if is_cut { instants[place + 1] - instants[place] } else { 0.0 };
            met[usize::from(is_cut)] += 1;
        }
        assert!((value(&run, "torque_saturated_s") - saturated).abs() < 1e-12, "{case:?}: {saturated}");
    }
    assert!(met.iter().all(|count| *count > 40), "{met:?}");
}
