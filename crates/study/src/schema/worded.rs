//! Closed sets of texts that say what each of them means.

/// An enum whose JSON is a text each, and whose schema keeps what each text means: a `oneOf` of constants with descriptions, where a
/// derived schema would only list the texts.
#[macro_export]
macro_rules! worded {
    (
        $(#[doc = $about:literal])*
        $vis:vis enum $name:ident { $(#[doc = $meaning:literal] $variant:ident = $text:literal,)+ }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, ::serde::Serialize, ::serde::Deserialize)]
        $vis enum $name { $(#[doc = $meaning] #[serde(rename = $text)] $variant,)+ }

        impl $name {
            /// All of them, in order.
            $vis const ALL: &[$name] = &[$($name::$variant),+];

            /// Its text.
            $vis fn as_str(self) -> &'static str {
                match self { $($name::$variant => $text),+ }
            }

            /// What it means.
            $vis fn meaning(self) -> &'static str {
                match self { $($name::$variant => $meaning.trim()),+ }
            }
        }

        impl ::utoipa::PartialSchema for $name {
            fn schema() -> ::utoipa::openapi::RefOr<::utoipa::openapi::Schema> {
                use ::utoipa::openapi::schema::{ObjectBuilder, OneOfBuilder, Type};
                let one = OneOfBuilder::new().description(Some([$($about.trim()),*].join("\n")));
                $(let one = one.item(
                    ObjectBuilder::new()
                        .schema_type(Type::String)
                        .enum_values(Some([$text]))
                        .description(Some($meaning.trim())),
                );)+
                one.into()
            }
        }

        impl ::utoipa::ToSchema for $name {}
    };
}
