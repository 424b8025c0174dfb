//! Relaxation in one dimension.

use super::form::{ClosedForm, ClosedFormError, YOUNGS_MODULUS, table};
use sinew_fem::hyperelastic::prony::{Symmetric, Term, check, stress, tangent_factor};

const TERMS: [Term; 2] = [
    Term {
        share: 0.3,
        time: 0.05,
    },
    Term {
        share: 0.2,
        time: 0.5,
    },
];

const LAW: &str = "prony .3/.05 s, .2/.5 s";
const CONVOLUTION: &str = "integral of E (1 - sum g + sum g e^(-t/tau)) over the strain's rate";

/// A bar that is strained along x, in steps.
struct Bar {
    before: f64,
    memories: [Symmetric<f64>; 2],
}

impl Bar {
    fn at_rest() -> Self {
        Self {
            before: 0.0,
            memories: [[0.0; 6]; 2],
        }
    }

    fn change(&mut self, strain: f64) -> Symmetric<f64> {
        let change = YOUNGS_MODULUS * (strain - self.before);
        self.before = strain;
        [change, 0.0, 0.0, 0.0, 0.0, 0.0]
    }

    fn step(&mut self, strain: f64, dt: f64) {
        let change = self.change(strain);
        for (memory, term) in self.memories.iter_mut().zip(TERMS) {
            *memory = term.over(dt).next(*memory, change);
        }
    }

    fn jump(&mut self, strain: f64) {
        let change = self.change(strain);
        for (memory, term) in self.memories.iter_mut().zip(TERMS) {
            *memory = term.jump(*memory, change);
        }
    }

    fn stress(&self) -> f64 {
        let elastic = [YOUNGS_MODULUS * self.before, 0.0, 0.0, 0.0, 0.0, 0.0];
        stress(&TERMS, elastic, &self.memories)[0]
    }
}

pub(super) fn relaxation(list: &mut Vec<ClosedForm>) -> Result<(), ClosedFormError> {
    check(&TERMS)?;
    let mut table = table(list, 1e-13, CONVOLUTION);
    for (dt, steps) in [(0.1, 10), (0.01, 100), (0.001, 1000)] {
        let mut bar = Bar::at_rest();
        for step in 1..=steps {
            bar.step(0.1 * f64::from(step) / f64::from(steps), dt);
        }
        let case = format!("ramp to strain .1 in 1 s by steps of {dt} s: stress (Pa)");
        table.add(LAW, case, 210.513265075897, bar.stress());
        let mut bar = Bar::at_rest();
        bar.jump(0.1);
        for _ in 0..steps {
            bar.step(0.1, dt);
        }
        let case = format!("strain .1 at once, after 1 s by steps of {dt} s: stress (Pa)");
        table.add(LAW, case, 184.473470042984, bar.stress());
        let mut bar = Bar::at_rest();
        for _ in 0..steps {
            bar.step(0.1, dt);
        }
        let asked = match steps {
            10 => 185.487262436104,
            100 => 184.568839499562,
            _ => 184.482949833795,
        };
        let case = format!("strain .1 over the first step of {dt} s, after 1 s: stress (Pa)");
        table.add(LAW, case, asked, bar.stress());
    }
    let case = "derivative of the stress by the elastic one after .01 s".to_owned();
    let factor = tangent_factor(&TERMS, 0.01);
    table.add(LAW, case, 0.969917137315474, factor);
    harmonic(list);
    Ok(())
}

/// Storage and loss modulus at 2 Hz by steps of 1e-4 s, whose error is of second order: 1e-4 of that at .01 s, which is 4e-4 and 1.3e-3.
fn harmonic(list: &mut Vec<ClosedForm>) {
    let mut table = table(list, 3e-7, CONVOLUTION);
    let frequency = 4.0 * std::f64::consts::PI;
    let (dt, period) = (1e-4, 5000_u32);
    let mut bar = Bar::at_rest();
    let [mut storage, mut loss] = [0.0; 2];
    // Twenty time constants until the beginning is forgotten, and one period.
    for step in 1..=21 * period {
        let angle = frequency * dt * f64::from(step % period);
        bar.step(angle.sin(), dt);
        if step > 20 * period {
            storage += bar.stress() * angle.sin();
            loss += bar.stress() * angle.cos();
        }
    }
    let mean = 2.0 / f64::from(period);
    let case = |what: &str| format!("harmonic strain of 2 Hz by steps of 1e-4 s: {what} (Pa)");
    table.add(
        LAW,
        case("storage modulus"),
        2729.90219353656,
        mean * storage,
    );
    table.add(LAW, case("loss modulus"), 581.657272831061, mean * loss);
}
