//! The example of a host whose geometry umbrage never sees.

#[path = "../../examples/own_buffers.rs"]
mod example;

#[test]
fn blocks_in_a_hosts_own_buffers_cast_shadows_and_come_and_go() {
    let share = |count| {
        let (picture, seen) = example::frames(count, (96, 72)).unwrap();
        assert!(picture.data.iter().all(|p| p[3] == 255), "a picture without holes");
        let dark = seen.data.iter().filter(|v| **v < 0.5).count();
        (dark as f64 / seen.data.len() as f64, seen.data)
    };
    let ((first, before), (later, after)) = (share(1), share(9));
    for dark in [first, later] {
        assert!((0.05..0.6).contains(&dark), "{dark} of the picture is in shadow");
    }
    let changed = before.iter().zip(&after).filter(|(a, b)| (*a - *b).abs() > 0.5).count();
    assert!(changed > 50, "{changed} pixels changed as blocks came and went");
    assert!(example::main().is_ok());
}
