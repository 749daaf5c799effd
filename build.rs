//! Finds the Embree that Debian installed, says which one it is to the code (`cfg(embree3)` or
//! `cfg(embree4)`), and links it.

use std::path::{Path, PathBuf};
use std::{env, fs, process};

/// Where Debian's `libembree-dev` puts its headers.
const HEADERS_OF_EMBREE_3: &str = "/usr/include/embree3/rtcore.h";
const HEADERS_OF_EMBREE_4: &str = "/usr/include/embree4/rtcore.h";

fn main() {
    println!("cargo::rustc-check-cfg=cfg(embree3, embree4)");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=vendor-ffi");
    println!("cargo::rerun-if-env-changed=COHORT_EMBREE");

    let prefer_3 = env::var("COHORT_EMBREE").is_ok_and(|version| version == "3");
    let has_3 = Path::new(HEADERS_OF_EMBREE_3).exists();
    let has_4 = Path::new(HEADERS_OF_EMBREE_4).exists();

    if has_4 && !(prefer_3 && has_3) {
        println!("cargo::rustc-cfg=embree4");
        println!("cargo::rerun-if-changed={HEADERS_OF_EMBREE_4}");
        check_embree4();
        compile_plain_c("streams_embree4.c", &[("COHORT_EMBREE4", None)]);
    } else if has_3 {
        println!("cargo::rustc-cfg=embree3");
        println!("cargo::rerun-if-changed={HEADERS_OF_EMBREE_3}");
        println!("cargo::rustc-link-lib=embree3");
        declare_embree3();
        compile_plain_c("streams_embree3.c", &[]);
    } else {
        fail(
            "Embree is not installed: install it with `apt-get install libembree-dev libclang-dev`.",
        );
    }
}

/// Embree 4 is declared (and linked) by the crate `embree4-sys`, whose own copy of the headers is
/// older than the library: let the C compiler compare what we rely on with the installed headers.
fn check_embree4() {
    let checked = cc::Build::new()
        .file("vendor-ffi/embree4_layout.c")
        .try_compile("embree4_layout");
    if let Err(error) = checked {
        fail(&format!(
            "The installed Embree 4 is not laid out like Embree 4.3, which Cohort is written for: {error}"
        ));
    }
}

/// Compiles the calls in plain C that `benches/intersection.rs` measures the safe layer against, as
/// optimised as they can be whatever the profile. Programs that do not call them do not contain them.
fn compile_plain_c(streams: &str, definitions: &[(&str, Option<&str>)]) {
    let folder = Path::new("vendor-ffi/plain_c");
    let mut build = cc::Build::new();
    build
        .files([folder.join("packets.c"), folder.join(streams)])
        .opt_level(3)
        .std("c11");
    for (name, value) in definitions {
        build.define(name, *value);
    }
    if let Err(error) = build.try_compile("cohort_plain_c") {
        fail(&format!("The calls in plain C cannot be compiled: {error}"));
    }
}

/// Declares Embree 3 as `embree4-sys` declares Embree 4, so that the same code reads both.
fn declare_embree3() {
    let declarations = bindgen::Builder::default()
        .header("vendor-ffi/embree3.h")
        .allowlist_function("rtc.*")
        .allowlist_type("RTC.*")
        .rustified_enum("RTCFormat|RTCBuildQuality|RTCDeviceProperty|RTCError")
        .rustified_enum("RTCBufferType|RTCGeometryType")
        .bitfield_enum("RTC.*Flags")
        .parse_callbacks(Box::new(ShortVariants))
        .generate();
    let declarations = match declarations {
        Ok(declarations) => declarations,
        Err(error) => fail(&format!("The headers of Embree 3 cannot be read: {error}")),
    };
    let out_dir = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
    if let Err(error) = fs::write(out_dir.join("embree3.rs"), declarations.to_string()) {
        fail(&format!(
            "The declarations of Embree 3 cannot be written: {error}"
        ));
    }
}

/// Names the variants as `embree4-sys` does: `RTCFormat::FLOAT3`, not
/// `RTCFormat::RTC_FORMAT_FLOAT3`.
#[derive(Debug)]
struct ShortVariants;

impl bindgen::callbacks::ParseCallbacks for ShortVariants {
    fn enum_variant_name(
        &self,
        _enum_name: Option<&str>,
        variant: &str,
        _value: bindgen::callbacks::EnumVariantValue,
    ) -> Option<String> {
        [
            "RTC_FORMAT_",
            "RTC_BUILD_QUALITY_",
            "RTC_DEVICE_PROPERTY_",
            "RTC_ERROR_",
            "RTC_BUFFER_TYPE_",
            "RTC_GEOMETRY_TYPE_",
            "RTC_SCENE_FLAG_",
            "RTC_INTERSECT_CONTEXT_FLAG_",
        ]
        .iter()
        .find_map(|prefix| variant.strip_prefix(prefix))
        .map(str::to_owned)
    }
}

/// Ends the build with one sentence for the person who started it.
fn fail(sentence: &str) -> ! {
    println!("cargo::error={}", sentence.replace('\n', " "));
    process::exit(1)
}
