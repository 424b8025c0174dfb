//! Commands that wait for their simulated time.

use std::collections::VecDeque;

use sinew_world::Command;

/// Commands for simulated times (s), in their order.
#[derive(Debug, Default)]
pub(super) struct Due(VecDeque<(f64, Command)>);

impl Due {
    /// Adds a command for a time (s) not before those of the others. Of several factors of a load at one time the
    /// last applies.
    pub(super) fn add(&mut self, t: f64, command: Command) {
        if let Command::LoadFactor { load, .. } = &command {
            let mut of_time = self.0.iter_mut().rev().take_while(|(due, _)| *due == t);
            let is_same = |other: &Command| matches!(other, Command::LoadFactor { load: other, .. } if other == load);
            if let Some((_, earlier)) = of_time.find(|(_, other)| is_same(other)) {
                *earlier = command;
                return;
            }
        }
        self.0.push_back((t, command));
    }

    /// Takes the first command, if its time is not after `t` (s).
    pub(super) fn next_until(&mut self, t: f64) -> Option<Command> {
        let (due, _) = self.0.front()?;
        if *due > t {
            return None;
        }
        self.0.pop_front().map(|(_, command)| command)
    }

    /// Number of cuts that wait.
    pub(super) fn cuts(&self) -> usize {
        let commands = self.0.iter();
        let cuts = commands.filter(|(_, command)| matches!(command, Command::Cut { .. }));
        cuts.count()
    }

    /// Takes all of them.
    pub(super) fn take(&mut self) -> Vec<(f64, Command)> {
        self.0.drain(..).collect()
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(load: &str, factor: f64) -> Command {
        let load = load.into();
        Command::LoadFactor { load, factor }
    }

    #[test]
    fn of_the_factors_of_a_load_for_one_time_the_last_is_kept() {
        let mut due = Due::default();
        for k in 0..1000 {
            due.add(0.5, factor("push", f64::from(k)));
            due.add(0.5, factor("pull", 2.0));
        }
        due.add(0.75, factor("push", 3.0));
        assert_eq!(due.next_until(0.4), None);
        assert_eq!(due.next_until(0.5), Some(factor("push", 999.0)));
        assert_eq!(
            due.take(),
            [(0.5, factor("pull", 2.0)), (0.75, factor("push", 3.0))]
        );
    }
}
