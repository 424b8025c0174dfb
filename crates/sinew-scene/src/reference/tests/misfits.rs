//! Values that do not fit.

use std::ops::Bound;

use toml::Value;

use crate::decode::Shape;

/// Values just outside the range of a key, and of other types.
pub(super) fn of(shape: &Shape) -> Vec<Value> {
    match shape {
        Shape::Number(low, high) => {
            let below = match *low {
                Bound::Included(low) => Some(low.next_down()),
                Bound::Excluded(low) => Some(low),
                Bound::Unbounded => None,
            };
            let above = match *high {
                Bound::Included(high) => Some(high.next_up()),
                Bound::Excluded(high) => Some(high),
                Bound::Unbounded => None,
            };
            let outside = below.into_iter().chain(above).map(Value::Float);
            outside.chain([true.into(), "x".into()]).collect()
        }
        Shape::Whole(least, most) => {
            let above = most.map(|most| most as i64 + 1);
            let outside = std::iter::once(*least as i64 - 1).chain(above);
            outside
                .map(Value::Integer)
                .chain([1.5.into(), "x".into()])
                .collect()
        }
        Shape::Flag => vec!["true".into(), 1.into()],
        Shape::Text { except, .. } => {
            let mut misfits = vec!["".into(), " ".into(), 1.into()];
            misfits.extend(except.map(Value::from));
            misfits
        }
        Shape::Words(_) => vec!["no such word".into(), 1.into()],
        Shape::List {
            of: item,
            least,
            most,
        } => {
            let length = (*least).max(1);
            let mut misfits: Vec<Value> = of(item)
                .into_iter()
                .map(|misfit| Value::Array(vec![misfit; length]))
                .collect();
            misfits.push(1.into());
            if *least > 0 {
                misfits.push(Value::Array(Vec::new()));
            }
            if let Some(most) = most {
                misfits.push(Value::Array(vec![1.into(); most + 1]));
            }
            misfits
        }
        Shape::Table(_) | Shape::Tables(_) => vec![1.into()],
        Shape::Either(forms) => {
            // Where a table says more about a name, any word is a name but a blank one.
            let is_name = matches!(&forms[..], [Shape::Text { .. }, Shape::Table(_)]);
            let text = if is_name { " " } else { "no such word" };
            vec![true.into(), text.into()]
        }
    }
}
