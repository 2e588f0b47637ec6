//! Numbers for scripts.

use serde_json::Value;

/// JSON has no infinity: what is not a finite number is null.
pub(super) fn finite(value: f64) -> Value {
    serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number)
}
