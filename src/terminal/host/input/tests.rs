//! Properties of the decoder for arbitrary bytes.

use crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use proptest::prelude::*;

use crate::terminal::host::input::Decoder;

/// The events of bytes that arrive together, followed by silence.
fn decode(bytes: &[u8]) -> Vec<Event> {
    let (mut decoder, mut events) = (Decoder::default(), Vec::new());
    decoder.feed(bytes, &mut events);
    while decoder.timeout().is_some() {
        decoder.on_timeout(&mut events);
    }
    events
}

fn key(code: KeyCode, modifiers: KeyModifiers) -> Event {
    Event::Key(KeyEvent::new(code, modifiers))
}

fn ctrl_c() -> Event {
    key(KeyCode::Char('c'), KeyModifiers::CONTROL)
}

#[test]
fn key_sequences_of_terminals_are_decoded() {
    use KeyModifiers as M;
    for (bytes, code, modifiers) in [
        (&b"a"[..], KeyCode::Char('a'), M::NONE),
        (b"A", KeyCode::Char('A'), M::SHIFT),
        ("ä".as_bytes(), KeyCode::Char('ä'), M::NONE),
        (b"\r", KeyCode::Enter, M::NONE),
        (b"\n", KeyCode::Char('j'), M::CONTROL),
        (b"\x7f", KeyCode::Backspace, M::NONE),
        (b"\x1a", KeyCode::Char('z'), M::CONTROL),
        (b"\0", KeyCode::Char(' '), M::CONTROL),
        (b"\x1b", KeyCode::Esc, M::NONE),
        (b"\x1bq", KeyCode::Char('q'), M::ALT),
        (b"\x1b[", KeyCode::Char('['), M::ALT),
        (b"\x1b]", KeyCode::Char(']'), M::ALT),
        (b"\x1b[A", KeyCode::Up, M::NONE),
        (b"\x1bOA", KeyCode::Up, M::NONE),
        (b"\x1b[1;2B", KeyCode::Down, M::SHIFT),
        (b"\x1b[1;5F", KeyCode::End, M::CONTROL),
        (b"\x1b[Z", KeyCode::BackTab, M::SHIFT),
        (b"\x1bOQ", KeyCode::F(2), M::NONE),
        (b"\x1b[1;2R", KeyCode::F(3), M::SHIFT),
        (b"\x1b[15~", KeyCode::F(5), M::NONE),
        (b"\x1b[24;3~", KeyCode::F(12), M::ALT),
        (b"\x1b[[C", KeyCode::F(3), M::NONE),
        (b"\x1b[3~", KeyCode::Delete, M::NONE),
        (b"\x1b[99;5u", KeyCode::Char('c'), M::CONTROL),
        (b"\x1b[27;5;99~", KeyCode::Char('c'), M::CONTROL),
        (b"\x1b[97:65;2u", KeyCode::Char('A'), M::NONE),
    ] {
        assert_eq!(decode(bytes), [key(code, modifiers)], "{:?}", String::from_utf8_lossy(bytes));
    }
}

#[test]
fn both_mouse_protocols_are_decoded() {
    use MouseEventKind as K;
    let at = |kind, column, row| Event::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
    assert_eq!(decode(b"\x1b[<0;34;16M"), [at(K::Down(MouseButton::Left), 33, 15)]);
    assert_eq!(decode(b"\x1b[<0;34;16m"), [at(K::Up(MouseButton::Left), 33, 15)]);
    assert_eq!(decode(b"\x1b[<32;1;1M"), [at(K::Drag(MouseButton::Left), 0, 0)]);
    assert_eq!(decode(b"\x1b[<65;2;3M"), [at(K::ScrollDown, 1, 2)]);
    assert_eq!(decode(b"\x1b[M !!"), [at(K::Down(MouseButton::Left), 0, 0)]);
    for nonsense in [&b"\x1b[<0;0;0M"[..], b"\x1b[<0;1M", b"\x1b[<999;1;1M", b"\x1b[0;1;1M", b"\x1b[M\x7f  "] {
        assert_eq!(decode(nonsense), [], "{:?}", String::from_utf8_lossy(nonsense));
    }
}

#[test]
fn terminal_replies_are_not_decoded_as_keys() {
    for reply in [
        &b"\x1b]11;rgb:1e1e/1e1e/2e2e\x07"[..],
        b"\x1b]11;rgb:1e1e/1e1e/2e2e\x1b\\",
        b"\x1bP>|tmux 3.3a\x1b\\",
        b"\x1bP1$r0m\x1b\\",
        b"\x1b_Gi=1;OK\x1b\\",
        b"\x1b[?62;22c",
        b"\x1b[?2026;2$y",
        b"\x1b[12;40R",
        b"\x1b[>0;276;0c",
        b"\x1b[4;600;800t",
        b"\x1b[201~",
    ] {
        assert_eq!(decode(reply), [], "{:?}", String::from_utf8_lossy(reply));
        let then_q = [reply, b"q"].concat();
        assert_eq!(decode(&then_q), [key(KeyCode::Char('q'), KeyModifiers::NONE)]);
    }
}

#[test]
fn a_paste_is_text_whatever_it_contains_or_follows() {
    let paste = |text: &str| Event::Paste(text.to_owned());
    let escape = key(KeyCode::Esc, KeyModifiers::NONE);
    assert_eq!(decode(b"\x1b[200~qqq\x1b[201~"), [paste("qqq")]);
    assert_eq!(decode(b"\x1b\x1b[200~qqq\x1b[201~"), [escape, paste("qqq")]);
    assert_eq!(decode(b"\x1b[200~a\x03b\x1b[20\x1b[31m\x1b[201~"), [paste("a\x03b\x1b[20\x1b[31m")]);
    assert_eq!(decode(b"\x1b[<\x1b[200~q\x1b[201~"), [paste("q")], "a sequence that was cut before it");
}

#[test]
fn a_paste_without_end_is_delivered_and_produces_no_keys() {
    let (mut decoder, mut events) = (Decoder::default(), Vec::new());
    decoder.feed(b"\x1b[200~one", &mut events);
    decoder.on_timeout(&mut events);
    decoder.feed(b"qqq\x1b[201~", &mut events);
    assert_eq!(events, [Event::Paste("one".into()), Event::Paste("qqq".into())]);
    events.clear();
    decoder.feed(b"\x1b[200~one", &mut events);
    decoder.on_timeout(&mut events);
    decoder.feed(b"q", &mut events);
    assert_eq!(events, [Event::Paste("one".into()), key(KeyCode::Char('q'), KeyModifiers::NONE)]);
}

fn pieces() -> impl Strategy<Value = Vec<u8>> {
    let known = prop::sample::select(vec![
        &b"\x1b"[..],
        b"\x1b[",
        b"\x1b[<",
        b"\x1b[<0;",
        b"\x1b[?",
        b"\x1b[M",
        b"\x1bO",
        b"\x1b]11;",
        b"\x1bP",
        b"\x07",
        b"\x1b\\",
        b"\x1b[200~",
        b"\x1b[201~",
        b"\x1b[1;",
        b"\x1b[[",
        b"0;1M",
        b"~",
        b"u",
        b"\xe2\x82",
        b"\x03",
        b"q",
        b"\x18",
    ])
    .prop_map(<[u8]>::to_vec);
    let any = prop::collection::vec(any::<u8>(), 0..4);
    prop::collection::vec(prop_oneof![3 => known, 1 => any], 0..12).prop_map(|pieces| pieces.concat())
}

proptest! {
    #[test]
    fn ctrl_c_is_decoded_after_any_incomplete_sequence(bytes in pieces()) {
        let (mut decoder, mut events) = (Decoder::default(), Vec::new());
        decoder.feed(&bytes, &mut events);
        // The decoder may wait at most 0.1 s here; the program promises 0.2 s, which a person would hardly notice.
        decoder.feed(b"\x03", &mut events);
        let mut waited = std::time::Duration::ZERO;
        while let Some(timeout) = decoder.timeout() {
            waited += timeout;
            decoder.on_timeout(&mut events);
        }
        prop_assert_eq!(events.last(), Some(&ctrl_c()));
        prop_assert!(waited.as_millis() <= 100, "{waited:?}");
    }

    #[test]
    fn decoding_does_not_depend_on_read_boundaries(bytes in pieces()) {
        let (mut decoder, mut events) = (Decoder::default(), Vec::new());
        for byte in &bytes {
            decoder.feed(&[*byte], &mut events);
        }
        while decoder.timeout().is_some() {
            decoder.on_timeout(&mut events);
        }
        prop_assert_eq!(events, decode(&bytes));
    }

    #[test]
    fn any_bytes_are_decoded_without_hanging(bytes in prop::collection::vec(any::<u8>(), 0..2000)) {
        decode(&bytes);
    }
}
