//! Rows of a table by their names: how fuels and salts are chosen in a scene file.

/// Makes a handle of a table's rows, which have a `name`: equal if the names are, written as its name in a scene file.
/// The first row is the default.
macro_rules! named_rows {
    ($(#[$doc:meta])* $handle:ident, $row:ty, $table:ident, $what:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $handle(&'static $row);

        impl $handle {
            /// Every one, in the order of a menu.
            pub fn all() -> impl ExactSizeIterator<Item = Self> {
                $table.iter().map(Self)
            }

            /// The one of a name in the scene file.
            pub fn named(name: &str) -> Option<Self> {
                Self::all().find(|row| row.name() == name)
            }

            /// The name in the scene file.
            pub fn name(self) -> &'static str {
                self.0.name
            }

            /// What is known of it.
            pub fn row(self) -> &'static $row {
                self.0
            }
        }

        impl Default for $handle {
            fn default() -> Self {
                Self(&$table[0])
            }
        }

        impl PartialEq for $handle {
            fn eq(&self, other: &Self) -> bool {
                self.name() == other.name()
            }
        }

        impl Eq for $handle {}

        impl std::fmt::Debug for $handle {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl serde::Serialize for $handle {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        impl<'de> serde::Deserialize<'de> for $handle {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let name = String::deserialize(deserializer)?;
                Self::named(&name)
                    .ok_or_else(|| serde::de::Error::custom(format!(concat!("there is no ", $what, " {:?}"), name)))
            }
        }
    };
}

pub(super) use named_rows;
