//! [`DelayQueue`]: commands on their way to the actuators.

use std::collections::VecDeque;

const MOST_ROOM: usize = 1000;

/// Commands that each act from a later time until the next one.
pub struct DelayQueue<C> {
    acting: C,
    /// Commands yet to act, with their ascending start times.
    waiting: VecDeque<(f64, C)>,
}

impl<C: Copy> DelayQueue<C> {
    /// `initial` acts until the first command. Reserves room for a command every `period` seconds at this delay.
    pub fn new(initial: C, delay: f64, period: f64) -> Self {
        let room = ((delay / period).ceil() as usize).min(MOST_ROOM) + 2;
        DelayQueue { acting: initial, waiting: VecDeque::with_capacity(room) }
    }

    /// Adds `command`, which acts from `time` on, no earlier than its predecessors.
    pub fn push(&mut self, time: f64, command: C) {
        debug_assert!(self.waiting.back().is_none_or(|(before, _)| *before <= time), "commands in order");
        self.waiting.push_back((time, command));
    }

    /// The command acting since the last [`DelayQueue::at`], and those under way.
    pub fn all(&self) -> (&C, impl Iterator<Item = &C>) {
        (&self.acting, self.waiting.iter().map(|(_, command)| command))
    }

    /// The command acting at `time`, and the start of the next one or infinity. Times ascend.
    pub fn at(&mut self, time: f64) -> (&C, f64) {
        while let Some((_, command)) = self.waiting.pop_front_if(|(from, _)| *from <= time) {
            self.acting = command;
        }
        (&self.acting, self.waiting.front().map_or(f64::INFINITY, |(from, _)| *from))
    }
}
