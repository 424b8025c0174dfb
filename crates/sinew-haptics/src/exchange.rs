//! The latest value from one thread to another, without waiting.

use triple_buffer::{Input, Output, triple_buffer};

/// The writing end: it never waits, and replaces a value that was not read.
#[derive(Debug)]
pub(crate) struct Publisher<T: Send>(Input<T>);

/// The reading end, for the latest value: it never waits, and never reads an incomplete value.
#[derive(Debug)]
pub(crate) struct Reader<T: Send>(Output<T>);

/// Both ends, with a first value: three buffers, one for each end and one between.
pub(crate) fn exchange<T: Clone + Send>(first: &T) -> (Publisher<T>, Reader<T>) {
    let (input, output) = triple_buffer(first);
    (Publisher(input), Reader(output))
}

impl<T: Send> Publisher<T> {
    /// Publishes a value.
    pub(crate) fn publish(&mut self, value: T) {
        self.0.write(value);
    }
}

impl<T: Send> Reader<T> {
    /// The latest value, if it was not read before.
    pub(crate) fn newer(&mut self) -> Option<&T> {
        self.0.update().then(|| self.0.output_buffer())
    }

    /// The latest value.
    pub(crate) fn latest(&mut self) -> &T {
        self.0.read()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_value_is_read_and_is_new_once() {
        let (mut publisher, mut reader) = exchange(&0);
        assert_eq!((reader.newer().copied(), *reader.latest()), (None, 0));
        publisher.publish(1);
        publisher.publish(2);
        assert_eq!(reader.newer().copied(), Some(2));
        assert_eq!((reader.newer().copied(), *reader.latest()), (None, 2));
    }

    #[test]
    fn values_from_another_thread_are_whole_and_in_order() {
        let (mut publisher, mut reader) = exchange(&[0_u64; 32]);
        let last = 20_000;
        std::thread::scope(|scope| {
            scope.spawn(move || (1..=last).for_each(|value| publisher.publish([value; 32])));
            let mut before = 0;
            while before < last {
                let values = reader.latest();
                assert!(values.iter().all(|value| *value == values[0]));
                assert!(values[0] >= before);
                before = values[0];
            }
        });
    }
}
