//! Engine values as JavaScript values.

use js_sys::{Array, Error, Float64Array, Object, Reflect};
use std::fmt::Display;
use wasm_bindgen::{JsCast, JsValue};

/// A plain JavaScript object that is filled field by field, in order.
pub(crate) struct Record(Object);

impl Record {
    pub(crate) fn new() -> Self {
        Record(Object::new())
    }

    pub(crate) fn with(self, name: &str, value: impl Into<JsValue>) -> Self {
        // Setting a field of a plain object cannot fail.
        let _ = Reflect::set(&self.0, &name.into(), &value.into());
        self
    }

    pub(crate) fn finish<T: JsCast>(self) -> T {
        self.0.unchecked_into()
    }
}

impl From<Record> for JsValue {
    fn from(record: Record) -> Self {
        record.0.into()
    }
}

pub(crate) fn numbers(values: &[f64]) -> Float64Array {
    Float64Array::from(values)
}

/// An ordinary array, for lists other than long arrays of numbers.
pub(crate) fn list<T: Into<JsValue>>(items: impl IntoIterator<Item = T>) -> Array {
    items.into_iter().map(Into::into).collect()
}

pub(crate) fn strings<T: Display>(items: impl IntoIterator<Item = T>) -> Array {
    list(items.into_iter().map(|item| item.to_string()))
}

/// A JavaScript error whose name is the Rust error's type.
pub(crate) fn error(kind: &str, cause: impl Display) -> JsValue {
    let error = Error::new(&cause.to_string());
    error.set_name(kind);
    error.into()
}

/// A number field of an object from JavaScript. A missing number becomes NaN, which every setting rejects.
pub(crate) fn number(object: &JsValue, name: &str) -> f64 {
    field(object, name).as_f64().unwrap_or(f64::NAN)
}

pub(crate) fn text(object: &JsValue, name: &str) -> String {
    field(object, name).as_string().unwrap_or_default()
}

/// A list of three numbers; a missing number becomes NaN.
pub(crate) fn point(object: &JsValue, name: &str) -> [f64; 3] {
    let list = Array::from(&field(object, name));
    std::array::from_fn(|k| list.get(k as u32).as_f64().unwrap_or(f64::NAN))
}

fn field(object: &JsValue, name: &str) -> JsValue {
    Reflect::get(object, &name.into()).unwrap_or(JsValue::UNDEFINED)
}
