//! Structs whose fields are known by name, docs and value, so that the JavaScript package can copy
//! them and declare their types without repeating them.

use std::{borrow::Cow, time::Duration};

/// A value in the form that JavaScript has.
pub enum Value<'a> {
    /// Not among the fields of the JavaScript object.
    Omitted,
    /// `null`.
    Null,
    /// A number.
    Number(f64),
    /// `true` or `false`.
    Bool(bool),
    /// A string.
    Text(Cow<'a, str>),
    /// An array.
    List(Vec<Value<'a>>),
    /// An object: its fields by their names.
    Object(Vec<(String, Value<'a>)>),
}

/// A type that fields may have.
pub trait Field {
    /// Returns the value in the form that JavaScript has.
    fn value(&self) -> Value<'_>;

    /// Returns the TypeScript type of [`value`](Field::value), or `None` if it is omitted.
    fn typescript() -> Option<String>;

    /// Returns the name in JavaScript of a field of this type.
    fn name(rust: &str) -> String {
        camel_case(rust)
    }
}

/// The declaration of a struct.
pub struct Struct {
    /// The name of the struct.
    pub name: &'static str,
    /// The attributes as source text, documentation included.
    pub attributes: &'static [&'static str],
    /// The fields in order.
    pub fields: &'static [FieldOfStruct],
}

/// The declaration of a field.
pub struct FieldOfStruct {
    /// Returns the name in JavaScript.
    pub name: fn() -> String,
    /// The attributes as source text, documentation included.
    pub attributes: &'static [&'static str],
    /// [`Field::typescript`] of the field's type.
    pub typescript: fn() -> Option<String>,
}

/// Declares a struct with named fields, and implements [`Field`] for it.
macro_rules! with_fields {
    (
        $(#[$attribute:meta])*
        pub struct $struct:ident {
            $($(#[$field_attribute:meta])* pub $field:ident: $type:ty,)*
        }
    ) => {
        $(#[$attribute])*
        pub struct $struct {
            $($(#[$field_attribute])* pub $field: $type,)*
        }

        impl $struct {
            /// How the struct is declared.
            #[doc(hidden)]
            pub const DECLARATION: $crate::fields::Struct = $crate::fields::Struct {
                name: stringify!($struct),
                attributes: &[$(stringify!($attribute)),*],
                fields: &[$($crate::fields::FieldOfStruct {
                    name: || <$type as $crate::fields::Field>::name(stringify!($field)),
                    attributes: &[$(stringify!($field_attribute)),*],
                    typescript: <$type as $crate::fields::Field>::typescript,
                }),*],
            };
        }

        impl $crate::fields::Field for $struct {
            fn value(&self) -> $crate::fields::Value<'_> {
                $crate::fields::Value::Object(vec![$((
                    <$type as $crate::fields::Field>::name(stringify!($field)),
                    $crate::fields::Field::value(&self.$field),
                )),*])
            }

            fn typescript() -> Option<String> {
                Some(stringify!($struct).to_owned())
            }
        }
    };
}
pub(crate) use with_fields;

/// Returns a Rust name in the form that JavaScript has: `flips_23` becomes `flips23`.
fn camel_case(rust: &str) -> String {
    let mut name = String::with_capacity(rust.len());
    let mut upper = false;
    for c in rust.chars() {
        match c {
            '_' => upper = true,
            _ => name.push(if std::mem::take(&mut upper) { c.to_ascii_uppercase() } else { c }),
        }
    }
    name
}

macro_rules! numbers {
    ($($type:ty),*) => {$(
        impl Field for $type {
            // JavaScript's numbers are exact up to 2⁵³.
            fn value(&self) -> Value<'_> {
                Value::Number(*self as f64)
            }

            fn typescript() -> Option<String> {
                Some("number".to_owned())
            }
        }
    )*};
}
numbers!(u32, u64, usize);

impl Field for Duration {
    fn value(&self) -> Value<'_> {
        Value::Number(1e3 * self.as_secs_f64())
    }

    fn typescript() -> Option<String> {
        Some("number".to_owned())
    }

    fn name(_: &str) -> String {
        "milliseconds".to_owned()
    }
}

impl Field for bool {
    fn value(&self) -> Value<'_> {
        Value::Bool(*self)
    }

    fn typescript() -> Option<String> {
        Some("boolean".to_owned())
    }
}

impl Field for String {
    fn value(&self) -> Value<'_> {
        Value::Text(self.as_str().into())
    }

    fn typescript() -> Option<String> {
        Some("string".to_owned())
    }
}

impl<T: Field> Field for Option<T> {
    fn value(&self) -> Value<'_> {
        self.as_ref().map_or(Value::Null, T::value)
    }

    fn typescript() -> Option<String> {
        T::typescript().map(|some| format!("{some} | null"))
    }
}

impl<T: Field> Field for Vec<T> {
    fn value(&self) -> Value<'_> {
        Value::List(self.iter().map(T::value).collect())
    }

    fn typescript() -> Option<String> {
        T::typescript().map(|element| format!("{element}[]"))
    }
}
