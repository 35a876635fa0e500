//! [`Request`]: what a campaign asks to observe of scenes of one kind; which columns, which series, which blocks and why.

use super::columns::{self, Column, Value, When};
use super::columns::{Own, Statistic};
use super::group::{Group, Groups};
use super::series::{PUBLISHED, Series, SeriesColumn};
use crate::dynamics::table::{Block, Blocks};

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
pub(super) struct Wanted(u32);

impl Wanted {
    pub(super) const fn with(self, series: Series) -> Self {
        Wanted(self.0 | 1 << series as u32)
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
    pub fn blocks(&self) -> Blocks {
        self.needs().into_iter().fold(Blocks::NONE, |blocks, (_, block, _)| blocks.with(block))
    }

    /// For each needed block, in the order of the table, which groups need it and for what.
    pub fn reasons(&self) -> Vec<(Block, String)> {
        let needs = self.needs();
        let reason = |block: Block| {
            let parts: Vec<String> = needs
                .iter()
                .filter(|(_, needed, _)| *needed == block)
                .map(|(group, _, why)| format!("{} ({why})", group.name()))
                .collect();
            (!parts.is_empty()).then(|| (block, parts.join(", ")))
        };
        Block::ALL.into_iter().filter_map(reason).collect()
    }

    /// The series that the columns are made of, with those that set their scales.
    pub(super) fn wanted(&self) -> Wanted {
        self.columns().into_iter().flat_map(|column| Self::sources(column.value)).fold(Wanted::default(), Wanted::with)
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
            Value::Own(Own::CorrelationWheel1 | Own::CorrelationWheel2 | Own::ExchangeFrequency) => {
                vec![Series::ComFuselage, Series::ComWheel1, Series::ComWheel2, Series::ComTotal]
            }
            Value::Own(_) => vec![],
        }
    }

    /// Every (group, block, purpose), each once, in the order of the columns.
    fn needs(&self) -> Vec<(Group, Block, &'static str)> {
        let mut needs = Vec::new();
        for column in self.columns() {
            let own = match column.value {
                Value::Own(own) => own.needs(),
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

impl Own {
    /// The block that the number is read from, beside the series it is made of.
    const fn needs(self) -> Option<(Block, &'static str)> {
        match self {
            Own::WorkThrusters | Own::WorkMotors => Some((Block::Work, "work of the actuators")),
            Own::AttitudeW | Own::AttitudeX | Own::AttitudeY | Own::AttitudeZ => {
                Some((Block::Attitude, "attitude at the end"))
            }
            Own::RateX | Own::RateY | Own::RateZ => Some((Block::Rate, "angular velocity at the end")),
            Own::WheelRate1 | Own::WheelRate2 => Some((Block::WheelRates, "wheel rates at the end")),
            Own::CorrelationWheel1
            | Own::CorrelationWheel2
            | Own::ExchangeFrequency
            | Own::TimeReached
            | Own::TimeFinal
            | Own::Steps
            | Own::Rejected
            | Own::Evaluations => None,
            Own::StateError => Some((Block::Rate, "how the motion amplifies errors")),
            Own::Amplification => Some((Block::WheelRates, "how the motion amplifies errors")),
            // the method's own errors of the attitude are known only where it is integrated
            Own::IllConditioned => Some((Block::Attitude, "errors of the attitude")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(groups: &[Group], debris: bool, actuated: bool, constrained: bool) -> Request {
        Request { groups: groups.iter().copied().collect(), debris, actuated, constrained }
    }

    fn set(blocks: &[Block]) -> Blocks {
        blocks.iter().fold(Blocks::NONE, |set, block| set.with(*block))
    }

    #[test]
    fn nothing_is_needed_that_nobody_asked_for() {
        use Block::*;
        use Group::{
            Constraints, Effort, Energies, EnergiesCom, EnergyConservation, Exchange, FinalState, MomentumConservation,
        };
        let spin = [Rate, WheelRates];
        let cases: [(&[Group], [bool; 3], &[Block]); 13] = [
            (&[], [true; 3], &[]),
            (&[Effort], [true; 3], &[]),
            (&[EnergiesCom], [true, false, false], &spin),
            (&[EnergiesCom, Exchange, Effort], [true, true, true], &spin),
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
            for block in [Block::WheelAngles, Block::ComPosition, Block::DebrisPosition] {
                assert!(!blocks.contains(block));
            }
        }
    }

    #[test]
    fn reasons_name_every_needed_block_and_no_other() {
        let request = Request { groups: Groups::ALL, debris: true, actuated: true, constrained: true };
        let reasons = request.reasons();
        assert_eq!(set(&reasons.iter().map(|(block, _)| *block).collect::<Vec<_>>()), request.blocks());
        let (_, why) = reasons.iter().find(|(block, _)| *block == Block::AngularImpulse).unwrap();
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
