//! [`DelayQueue`]: commands on their way to the actuators.

use std::collections::VecDeque;

/// Room for commands on their way is not reserved beyond this; a longer delay takes it as it needs it.
const MOST_ROOM: usize = 1000;

/// Commands that act from a later time on, each until the next one does. A command computed at a tick acts after the
/// delay, which has any length.
#[derive(Clone, Debug)]
pub struct DelayQueue<C> {
    acting: C,
    /// The commands that do not act yet, with the time from which they do, s, ascending.
    waiting: VecDeque<(f64, C)>,
}

impl<C: Copy> DelayQueue<C> {
    /// `initial` acts until the first command does. Has room for what is on its way at a delay of `delay` seconds and a
    /// command every `period` seconds, so that nothing is allocated later.
    pub fn new(initial: C, delay: f64, period: f64) -> Self {
        let room = ((delay / period).ceil() as usize).min(MOST_ROOM) + 2;
        DelayQueue { acting: initial, waiting: VecDeque::with_capacity(room) }
    }

    /// `initial` acts for ever: no room is reserved for others.
    pub fn constant(initial: C) -> Self {
        DelayQueue { acting: initial, waiting: VecDeque::new() }
    }

    /// Adds `command`, which acts from `time` on, s: not before those that were added earlier.
    pub fn push(&mut self, time: f64, command: C) {
        debug_assert!(self.waiting.back().is_none_or(|(before, _)| *before <= time), "commands in order");
        self.waiting.push_back((time, command));
    }

    /// The command that acts since the last call of [`DelayQueue::at`], and those on their way.
    pub fn all(&self) -> (&C, impl Iterator<Item = &C>) {
        (&self.acting, self.waiting.iter().map(|(_, command)| command))
    }

    /// The command that acts at `time`, and when the next one takes its place: infinite where none is on its way. Times
    /// ascend from call to call.
    pub fn at(&mut self, time: f64) -> (&C, f64) {
        while let Some((_, command)) = self.waiting.pop_front_if(|(from, _)| *from <= time) {
            self.acting = command;
        }
        (&self.acting, self.waiting.front().map_or(f64::INFINITY, |(from, _)| *from))
    }
}
