//! Files as programs write them: UTF-8 with and without a byte order mark, and UTF-16 as Windows PowerShell 5 does.

use qhat_scene::{Format, load_bytes};

const SCENE: &str = "schema = \"qhat/1\"\r\nname = \"Fall, ½ g t²\"\r\ndimension = 2\r\n\
                     particles = [{ id = \"a\", at = [0.0, 0.0] }]\r\n";

#[test]
fn utf_16_is_read_as_utf_8_is() {
    let unit = |swap: bool| move |unit: u16| if swap { unit.to_be_bytes() } else { unit.to_le_bytes() };
    for swap in [false, true] {
        let bytes: Vec<u8> = format!("\u{FEFF}{SCENE}").encode_utf16().flat_map(unit(swap)).collect();
        let scene = load_bytes(&bytes, "my.toml", Format::Toml).unwrap();
        assert_eq!(scene.name, "Fall, ½ g t²");
    }
    let marked = [b"\xEF\xBB\xBF", SCENE.as_bytes()].concat();
    assert_eq!(load_bytes(&marked, "my.toml", Format::Toml).unwrap().name, "Fall, ½ g t²");
}

/// An error in such a file has the place that an editor shows, and half a character is no panic.
#[test]
fn errors_in_utf_16_have_their_place() {
    let wrong = SCENE.replace("at = [0.0, 0.0]", "at = [0.0]");
    let mut bytes: Vec<u8> = format!("\u{FEFF}{wrong}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let errors = load_bytes(&bytes, "my.toml", Format::Toml).unwrap_err();
    assert_eq!((errors.errors[0].line, errors.errors[0].column), (4, 31));
    bytes.pop();
    assert!(load_bytes(&bytes, "my.toml", Format::Toml).is_err());
    assert!(load_bytes(&[0xFF, 0xFE, 0x00, 0xD8], "my.toml", Format::Toml).is_err());
}
