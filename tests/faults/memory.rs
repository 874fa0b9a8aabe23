//! Memory of the adapter that is used up.

#![cfg(target_os = "linux")]

use crate::support::{EVAL, RENDER, Writes, adapter, contents};

/// What Vulkan makes in memory.
const MADE: [&str; 11] = [
    "vkAllocateMemory",
    "vkCreateBuffer",
    "vkCreateImage",
    "vkCreateImageView",
    "vkCreateFramebuffer",
    "vkCreateRenderPass",
    "vkCreateShaderModule",
    "vkCreateComputePipelines",
    "vkCreateGraphicsPipelines",
    "vkCreateDescriptorPool",
    "vkCreateCommandPool",
];

#[test]
fn memory_that_ends_anywhere_leaves_every_file_as_it_was() {
    let Some(_alone) = adapter() else { return };
    for (command, functions) in [(&RENDER, &MADE[..]), (&EVAL, &MADE[..2])] {
        for function in functions {
            // 1, 4, 16, ... until the run has fewer calls
            let told = ["out of memory on the adapter in ", "gives no device"];
            let fails = |power: &u32| {
                let fault = format!("{function} {} memory", 1 << (2 * power));
                command.fails_at("memory", &fault, &told)
            };
            let struck = (0..).take_while(fails).count();
            println!("{}: {struck} times without memory in {function}", command.name);
            assert!(struck > 0, "{function}");
        }
    }
}

#[test]
fn maps_that_do_not_fit_into_memory_are_refused_with_the_step_and_the_remedy() {
    let Some((device, _alone)) = adapter() else { return };
    if !device.info.name.contains("llvmpipe") {
        return println!("skipped: the memory of {} is not the program's", device.info.name);
    }
    let arguments = &["render", "seam-box", "--size", "16384", "--image", "16x16", "-o", "a.png"];
    let render = Writes { name: "large", arguments, files: &["a.png"] };
    let folder = render.folder("real");
    let before = contents(&folder);
    // the maps alone are 2 x 16384^2 x 4 B = 2097152 KiB
    let run = render.run(&folder, "gpu", "ulimit -v 2000000;", &[]);
    run.failed("real", 1, "use a smaller size");
    assert!(run.stderr.contains("out of memory on the adapter in the maps' texture"), "{run:?}");
    assert_eq!(contents(&folder), before);
}
