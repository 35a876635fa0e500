//! [`Request`]: what a campaign asks to observe of scenes of one kind; which columns, which series, which blocks and why.

use super::columns::{self, Column, Value, When};
use super::columns::{DirectValue, Statistic};
use super::group::{Group, Groups};
use super::series::{PUBLISHED, Series, SeriesColumn};
use crate::run::{StateField, StateFields};

/// What is asked for, and what kind of scene it is asked of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// The groups asked for.
    pub groups: Groups,
    /// Whether there is a debris body.
    pub debris: bool,
    /// Whether thrusters or wheel motors work at any time.
    pub actuated: bool,
    /// Whether the kernel has constraints (and integrates the DCM itself).
    pub constrained: bool,
}

/// A set of series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SeriesSet(u32);

impl SeriesSet {
    pub(super) const fn with(self, series: Series) -> Self {
        SeriesSet(self.0 | 1 << series as u32)
    }

    pub(super) const fn has(self, series: Series) -> bool {
        self.has_index(series as usize)
    }

    pub(super) const fn has_index(self, series: usize) -> bool {
        self.0 & (1 << series) != 0
    }
}

impl Request {
    /// The columns of a row, in order: those of the groups asked for that apply to such a scene.
    pub fn columns(&self) -> Vec<&'static Column> {
        columns::all().filter(|column| self.groups.contains(column.group) && self.applies(column.when)).collect()
    }

    /// The columns of a time series, in order: the series behind [`Request::columns`] that have one.
    pub fn series(&self) -> Vec<&'static SeriesColumn> {
        let wanted = self.wanted();
        PUBLISHED.iter().filter(|column| wanted.has(column.series)).collect()
    }

    /// The blocks of the state table that the columns need; no other is read.
    pub fn blocks(&self) -> StateFields {
        self.needs().into_iter().fold(StateFields::NONE, |blocks, (_, block, _)| blocks.with(block))
    }

    /// For each needed block, in the order of the table, which groups need it and for what.
    pub fn reasons(&self) -> Vec<(StateField, String)> {
        let needs = self.needs();
        let reason = |block: StateField| {
            let parts: Vec<String> = needs
                .iter()
                .filter(|(_, needed, _)| *needed == block)
                .map(|(group, _, why)| format!("{} ({why})", group.name()))
                .collect();
            (!parts.is_empty()).then(|| (block, parts.join(", ")))
        };
        StateField::ALL.into_iter().filter_map(reason).collect()
    }

    /// The series that the columns are made of, with those that set their scales.
    pub(super) fn wanted(&self) -> SeriesSet {
        self.columns()
            .into_iter()
            .flat_map(|column| Self::sources(column.value))
            .fold(SeriesSet::default(), SeriesSet::with)
    }

    fn applies(&self, when: When) -> bool {
        match when {
            When::Always => true,
            When::Debris => self.debris,
            When::Actuated => self.actuated,
            When::Free => !self.actuated,
            When::Constrained => self.constrained,
        }
    }

    /// The series that a value is made of.
    fn sources(value: Value) -> Vec<Series> {
        match value {
            Value::Of(series, Statistic::Fraction) => vec![series, Series::ComTotal],
            Value::Of(series, _) => series.scale().into_iter().chain([series]).collect(),
            Value::DirectValue(
                DirectValue::CorrelationWheel1 | DirectValue::CorrelationWheel2 | DirectValue::ExchangeFrequency,
            ) => {
                vec![Series::ComFuselage, Series::ComWheel1, Series::ComWheel2, Series::ComTotal]
            }
            Value::DirectValue(_) => vec![],
        }
    }

    /// Every (group, block, purpose), each once, in the order of the columns.
    fn needs(&self) -> Vec<(Group, StateField, &'static str)> {
        let mut needs = Vec::new();
        for column in self.columns() {
            let own = match column.value {
                Value::DirectValue(own) => own.needs(),
                Value::Of(..) => None,
            };
            let series = Self::sources(column.value).into_iter().flat_map(|series| series.needs(self));
            for (block, why) in series.chain(own) {
                if !needs.contains(&(column.group, block, why)) {
                    needs.push((column.group, block, why));
                }
            }
        }
        needs
    }
}

impl DirectValue {
    /// The block that the number is read from, beside the series it is made of.
    const fn needs(self) -> Option<(StateField, &'static str)> {
        match self {
            DirectValue::WorkThrusters | DirectValue::WorkMotors => Some((StateField::Work, "work of the actuators")),
            DirectValue::AttitudeW | DirectValue::AttitudeX | DirectValue::AttitudeY | DirectValue::AttitudeZ => {
                Some((StateField::Attitude, "attitude at the end"))
            }
            DirectValue::RateX | DirectValue::RateY | DirectValue::RateZ => {
                Some((StateField::Rate, "angular velocity at the end"))
            }
            DirectValue::WheelRate1 | DirectValue::WheelRate2 => {
                Some((StateField::WheelRates, "wheel rates at the end"))
            }
            DirectValue::CorrelationWheel1
            | DirectValue::CorrelationWheel2
            | DirectValue::ExchangeFrequency
            | DirectValue::TimeReached
            | DirectValue::TimeFinal
            | DirectValue::Steps
            | DirectValue::Rejected
            | DirectValue::Evaluations => None,
            DirectValue::StateError => Some((StateField::Rate, "how the motion amplifies errors")),
            DirectValue::Amplification => Some((StateField::WheelRates, "how the motion amplifies errors")),
            // the method's own errors of the attitude are known only where it is integrated
            DirectValue::IllConditioned => Some((StateField::Attitude, "errors of the attitude")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(groups: &[Group], debris: bool, actuated: bool, constrained: bool) -> Request {
        Request { groups: groups.iter().copied().collect(), debris, actuated, constrained }
    }

    fn set(blocks: &[StateField]) -> StateFields {
        blocks.iter().fold(StateFields::NONE, |set, block| set.with(*block))
    }

    #[test]
    fn nothing_is_needed_that_nobody_asked_for() {
        use Group::{
            Constraints, Energies, EnergiesCom, EnergyConservation, Exchange, FinalState, MomentumConservation,
            StepStatistics,
        };
        use StateField::*;
        let spin = [Rate, WheelRates];
        let cases: [(&[Group], [bool; 3], &[StateField]); 13] = [
            (&[], [true; 3], &[]),
            (&[StepStatistics], [true; 3], &[]),
            (&[EnergiesCom], [true, false, false], &spin),
            (&[EnergiesCom, Exchange, StepStatistics], [true, true, true], &spin),
            (&[EnergyConservation], [false; 3], &[Rate, WheelRates, ComVelocity]),
            (&[EnergyConservation], [false, true, false], &[Rate, WheelRates, ComVelocity, Work]),
            (&[EnergyConservation], [true, false, false], &[Rate, WheelRates, ComVelocity, DebrisVelocity, DebrisRate]),
            (&[Energies], [false; 3], &[Rate, Attitude, WheelRates, ComVelocity]),
            (&[Energies], [false, false, true], &[Rate, Dcm, WheelRates, ComVelocity, KineticEnergies]),
            (
                &[MomentumConservation],
                [true, true, false],
                &[
                    Rate,
                    Attitude,
                    WheelRates,
                    ComVelocity,
                    Impulse,
                    AngularImpulse,
                    DebrisVelocity,
                    DebrisRate,
                    DebrisAttitude,
                ],
            ),
            (&[Group::Attitude], [true, true, false], &[Attitude]),
            (&[Constraints], [true, true, false], &[]),
            (&[FinalState], [true, true, true], &[Rate, Attitude, WheelRates]),
        ];
        for (groups, [debris, actuated, constrained], blocks) in cases {
            let request = request(groups, debris, actuated, constrained);
            assert_eq!(request.blocks(), set(blocks), "{request:?}");
        }
    }

    #[test]
    fn wheel_angles_and_positions_are_never_read() {
        for [debris, actuated, constrained] in [[false; 3], [true; 3]] {
            let blocks = Request { groups: Groups::ALL, debris, actuated, constrained }.blocks();
            for block in [StateField::WheelAngles, StateField::ComPosition, StateField::DebrisPosition] {
                assert!(!blocks.contains(block));
            }
        }
    }

    #[test]
    fn reasons_name_every_needed_block_and_no_other() {
        let request = Request { groups: Groups::ALL, debris: true, actuated: true, constrained: true };
        let reasons = request.reasons();
        assert_eq!(set(&reasons.iter().map(|(block, _)| *block).collect::<Vec<_>>()), request.blocks());
        let (_, why) = reasons.iter().find(|(block, _)| *block == StateField::AngularImpulse).unwrap();
        assert_eq!(why, "momentum_conservation (angular impulse of the thrusters)");
    }

    #[test]
    fn columns_apply_to_scenes_that_have_what_they_measure() {
        let names = |debris, actuated, constrained| -> Vec<&str> {
            Request { groups: Groups::ALL, debris, actuated, constrained }.columns().iter().map(|c| c.name).collect()
        };
        let bare = names(false, false, false);
        let full = names(true, true, true);
        for (name, in_bare, in_full) in [
            ("energy_debris_max_j", false, true),
            ("work_motors_final_j", false, true),
            ("residual_collocation_max_m", false, true),
            ("energy_com_error_max", true, false),
            ("energy_error_max", true, true),
        ] {
            assert_eq!(bare.contains(&name), in_bare, "{name}");
            assert_eq!(full.contains(&name), in_full, "{name}");
        }
    }
}
