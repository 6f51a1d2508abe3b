//! The target that `FUZZ_TARGET` names, with a limit on memory.
#![no_main]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::LazyLock;
use targets::{TARGETS, Target};

#[path = "../../suite/fuzz/targets.rs"]
#[allow(dead_code, reason = "what the test suite makes of other tests' inputs")]
mod targets;

/// One allocation may not be larger, bytes: inputs are some kilobytes, and pictures are not made here.
const LARGEST_ALLOCATION: usize = 64 << 20;

/// Memory that refuses what only a lying header can ask for.
struct Limited;

// SAFETY: everything is handed on to the system's allocator; a refusal is the null pointer that `alloc` may give.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if layout.size() > LARGEST_ALLOCATION {
            return std::ptr::null_mut();
        }
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static MEMORY: Limited = Limited;

static TARGET: LazyLock<&Target> = LazyLock::new(|| {
    let name = std::env::var("FUZZ_TARGET").unwrap_or_default();
    let names = TARGETS.map(|t| t.name).join(", ");
    let found = TARGETS.iter().find(|t| t.name == name);
    found.unwrap_or_else(|| panic!("FUZZ_TARGET is \"{name}\", wanted is one of {names}"))
});

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    (TARGET.run)(bytes);
});
