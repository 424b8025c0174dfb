//! Numbers along three axes, each of which may depend on the position.

use toml::de::DeValue;

use crate::decode::value::{Misfit, finite, list, text};
use crate::decode::{Kind, Shape, Values};
use crate::formula::Formula;

/// Three numbers or formulas, along x, y and z; the text describes the values that fit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Field(pub(super) &'static str);

impl Kind for Field {
    fn expected(&self) -> String {
        self.0.to_owned()
    }

    fn shape(&self) -> Shape {
        let number = Shape::Number(std::ops::Bound::Unbounded, std::ops::Bound::Unbounded);
        let formula = Shape::Text {
            pattern: Some("^[-+*/^()0-9.\\seExyzpisncoqrtab]+$"),
            except: None,
        };
        Shape::List {
            of: Box::new(Shape::Either(vec![number, formula])),
            least: 3,
            most: Some(3),
        }
    }
}

impl Values for Field {
    type Read = [Formula; 3];

    fn read(&self, value: &DeValue<'_>) -> Result<[Formula; 3], Misfit> {
        let items = list(value, |item| match item {
            DeValue::String(_) => Formula::parse(&text(item)?).map_err(|_| Misfit::Formula),
            _ => Ok(Formula::from(finite(item)?)),
        })?;
        <[Formula; 3]>::try_from(items).map_err(|_| Misfit::Value)
    }
}
