//! No driver, or no adapter of the kind that is asked for.

use crate::support::{EVAL, RENDER, adapter, contents};

/// Vulkan's loader finds drivers by these alone.
const NO_DRIVER: [(&str, &str); 2] =
    [("VK_DRIVER_FILES", "/nonexistent"), ("VK_ICD_FILENAMES", "/nonexistent")];

#[cfg(target_os = "linux")]
#[test]
fn without_a_driver_the_program_says_what_to_install() {
    for back_end in ["", "vulkan", "metal", "nonsense"] {
        let folder = RENDER.folder("no-driver");
        let before = contents(&folder);
        let variables = [&NO_DRIVER[..], &[("WGPU_BACKEND", back_end)]].concat();
        let run = RENDER.run(&folder, "gpu", "", &variables);
        run.failed(back_end, 2, "apt-get install mesa-vulkan-drivers");
        assert!(run.stderr.contains("found: none"), "{run:?}");
        assert!(run.stderr.contains(back_end), "{run:?}");
        assert_eq!(contents(&folder), before);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_driver_the_ports_run_where_any_adapter_will_do() {
    let folder = EVAL.folder("ports");
    let run = EVAL.run(&folder, "auto", "", &NO_DRIVER);
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(run.stderr.contains("no usable adapter"), "{run:?}");
    assert!(run.stderr.contains("scalar ports"), "{run:?}");
    assert!(std::fs::read_to_string(folder.join("errors.csv")).unwrap().contains("record,"));
}

#[cfg(target_os = "linux")]
#[test]
fn where_any_adapter_will_do_the_ports_run_in_place_of_one_that_does_not_open() {
    let Some(_alone) = adapter() else { return };
    for (fault, told) in [
        ("vkAllocateMemory 1 memory", "gives no device"),
        ("vkAllocateMemory 1 sleeps", "did not finish opening within 1 s"),
    ] {
        let folder = EVAL.folder("unopened");
        let run = EVAL.struck(&folder, "auto", fault, &[("DPSM_PATIENCE", "1")]);
        assert_eq!(run.code, Some(0), "{run:?}");
        assert!(run.stderr.contains(told), "{run:?}");
        assert!(run.stderr.contains("scalar ports"), "{run:?}");
        assert!(std::fs::read_to_string(folder.join("errors.csv")).unwrap().contains("record,"));
    }
}
