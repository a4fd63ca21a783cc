#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use proptest::prelude::*;
use serde_json::json;

use super::*;

fn text(json: &str) -> String {
    canonical(serde_json::from_str(json).unwrap()).unwrap()
}

/// RFC 8785, section 3.2.2 and its bytes in 3.2.4.
#[test]
fn the_rfcs_example() {
    let input = r#"{
        "numbers": [333333333.33333329, 1E30, 4.50, 2e-3, 0.000000000000000000000000001],
        "string": "\u20ac$\u000F\u000aA'\u0042\u0022\u005c\\\"\/",
        "literals": [null, true, false]
    }"#;
    let bytes = "7b 22 6c 69 74 65 72 61 6c 73 22 3a 5b 6e 75 6c 6c 2c 74 72 75 65 2c 66 61 6c 73 65 5d 2c 22 6e 75 6d 62 65 72 73 \
        22 3a 5b 33 33 33 33 33 33 33 33 33 2e 33 33 33 33 33 33 33 2c 31 65 2b 33 30 2c 34 2e 35 2c 30 2e 30 30 32 2c 31 65 2d 32 \
        37 5d 2c 22 73 74 72 69 6e 67 22 3a 22 e2 82 ac 24 5c 75 30 30 30 66 5c 6e 41 27 42 5c 22 5c 5c 5c 5c 5c 22 2f 22 7d";
    assert_eq!(text(input).into_bytes(), hex::decode(bytes.replace(' ', "")).unwrap());
}

/// RFC 8785, section 3.2.3: UTF-16 puts the smiley before the Hebrew letter, UTF-8 would not.
#[test]
fn members_stand_in_the_order_of_their_utf16() {
    let input = r#"{
        "\u20ac": "Euro Sign", "\r": "Carriage Return", "\ufb33": "Hebrew Letter Dalet With Dagesh", "1": "One",
        "\ud83d\ude00": "Emoji: Grinning Face", "\u0080": "Control", "\u00f6": "Latin Small Letter O With Diaeresis"
    }"#;
    let expected = [
        "Carriage Return",
        "One",
        "Control",
        "Latin Small Letter O With Diaeresis",
        "Euro Sign",
        "Emoji: Grinning Face",
        "Hebrew Letter Dalet With Dagesh",
    ];
    let places = |text: &str| expected.map(|value| text.find(value).unwrap());
    assert!(places(&text(input)).is_sorted(), "{}", text(input));
    // Negative control: serde_json's own order is that of UTF-8.
    let own = serde_json::from_str::<Value>(input).unwrap().to_string();
    assert!(!places(&own).is_sorted(), "{own}");
}

/// RFC 8785, appendix B.
#[test]
fn numbers_as_ecmascript_writes_them() {
    let numbers = [
        (0x0000_0000_0000_0000, "0"),
        (0x8000_0000_0000_0000, "0"),
        (0x0000_0000_0000_0001, "5e-324"),
        (0x8000_0000_0000_0001, "-5e-324"),
        (0x7fef_ffff_ffff_ffff, "1.7976931348623157e+308"),
        (0xffef_ffff_ffff_ffff, "-1.7976931348623157e+308"),
        (0x4340_0000_0000_0000, "9007199254740992"),
        (0xc340_0000_0000_0000, "-9007199254740992"),
        (0x4430_0000_0000_0000, "295147905179352830000"),
        (0x44b5_2d02_c7e1_4af5, "9.999999999999997e+22"),
        (0x44b5_2d02_c7e1_4af6, "1e+23"),
        (0x44b5_2d02_c7e1_4af7, "1.0000000000000001e+23"),
        (0x444b_1ae4_d6e2_ef4e, "999999999999999700000"),
        (0x444b_1ae4_d6e2_ef4f, "999999999999999900000"),
        (0x444b_1ae4_d6e2_ef50, "1e+21"),
        (0x3eb0_c6f7_a0b5_ed8c, "9.999999999999997e-7"),
        (0x3eb0_c6f7_a0b5_ed8d, "0.000001"),
        (0x41b3_de43_5555_5553, "333333333.3333332"),
        (0x41b3_de43_5555_5554, "333333333.33333325"),
        (0x41b3_de43_5555_5555, "333333333.3333333"),
        (0x41b3_de43_5555_5556, "333333333.3333334"),
        (0x41b3_de43_5555_5557, "333333333.33333343"),
        (0xbecb_f647_612f_3696, "-0.0000033333333333333333"),
        (0x4314_3ff3_c1cb_0959, "1424953923781206.2"),
    ];
    for (bits, expected) in numbers {
        assert_eq!(canonical(json!(f64::from_bits(bits))).unwrap(), expected, "{bits:x}");
    }
    for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = exact(&number).unwrap_err().to_string();
        assert!(error.contains("finite") && error.contains(&number.to_string()), "{error}");
    }
}

#[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct Nested {
    numbers: Vec<f64>,
    maybe: Option<f64>,
}

/// The canonicalizer refuses such a number alone, and writes null for it within anything.
#[test]
fn what_is_not_finite_is_refused_wherever_it_stands() {
    let nested = |number: f64, maybe| Nested { numbers: vec![1.0, number], maybe };
    assert!(serde_json_canonicalizer::to_string(&nested(f64::NAN, None)).unwrap().contains("null"));
    assert!(exact(&nested(f64::NAN, None)).is_err());
    assert!(exact(&nested(f64::INFINITY, None)).is_err());
    assert!(exact(&nested(0.0, Some(f64::NEG_INFINITY))).is_err());
    let fine = exact(&nested(-0.0, None)).unwrap();
    assert_eq!(canonical(fine).unwrap(), r#"{"maybe":null,"numbers":[1,0]}"#);
}

#[test]
fn whole_numbers_are_exact_whatever_their_size() {
    let one_text = ["7", "7.0", "70e-1"].map(text);
    assert!(one_text.iter().all(|text| text == "7"), "{one_text:?}");
    assert_eq!(text("[9007199254740992, -9007199254740992]"), "[9007199254740992,-9007199254740992]");
    // Its neighbour has another text, which rounding to f64 would take from it.
    assert_eq!(text(r#"{"seed":[9007199254740993]}"#), r#"{"seed":["9007199254740993"]}"#);
    assert_eq!(text("-9007199254740993"), r#""-9007199254740993""#);
    assert_eq!(canonical(json!(u64::MAX)).unwrap(), r#""18446744073709551615""#);
    assert_eq!(text("1e300"), "1e+300");
}

/// Any JSON: names and texts of all of Unicode, whole numbers and others, a few levels deep.
fn any_json() -> impl Strategy<Value = Value> {
    let name = prop_oneof![3 => "[a-z_]{1,6}", 1 => any::<String>()];
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        (-1_000i64..1_000).prop_map(Value::from),
        any::<String>().prop_map(Value::from),
        proptest::num::f64::NORMAL.prop_map(Value::from),
    ];
    leaf.prop_recursive(3, 24, 4, move |inner| {
        prop_oneof![
            proptest::collection::vec(inner.clone(), 0..4).prop_map(Value::from),
            proptest::collection::btree_map(name.clone(), inner, 0..4)
                .prop_map(|members| Value::Object(members.into_iter().collect())),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, ..ProptestConfig::default() })]

    /// The short way and the canonicalizer write the same bytes, and every control character is among what they write.
    #[test]
    fn the_short_way_writes_what_the_canonicalizer_writes(mut value in any_json()) {
        let text = canonical(value.clone()).unwrap();
        quote(&mut value);
        prop_assert_eq!(text, serde_json_canonicalizer::to_string(&value).unwrap());
    }
}

#[test]
fn the_short_way_is_taken_where_it_is_right_and_there_alone() {
    let every: String = (0..=0x2000).filter_map(char::from_u32).collect();
    let plain = json!({ "a": [every, -7, null, true], "b": {} });
    assert!(is_canonical(&plain));
    assert_eq!(canonical(plain.clone()).unwrap(), serde_json_canonicalizer::to_string(&plain).unwrap());
    for other in [json!(0.5), json!([{ "\u{e9}": 1 }]), json!({ "a": { "\u{ffff}": 1, "\u{1f600}": 2 } })] {
        assert!(!is_canonical(&other), "{other}");
    }
}
