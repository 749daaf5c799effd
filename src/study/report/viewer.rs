//! The page's images: the slider between two, all side by side, crops and errors. `page.js` links their zoom.

use std::path::Path;

use maud::{Markup, html};

use super::ReportError;
use super::numbers::{counted, short, significant};
use super::pictures::{Picture, data_uri, read};
use super::plots::colour;
use crate::study::false_colour;
use crate::study::results::{Competitor, Results, StudyKind};

/// Colours of the marks around crops.
const MARKS: [&str; 4] = ["#ffd400", "#00e5ff", "#ff5cf4", "#7dff5c"];

/// The images of one competitor as addresses that hold them.
pub struct CompetitorImages {
    one: String,
    /// The mean of all repetitions; `None` where there is no other than `one`, or where it would be too much.
    mean: Option<String>,
    error: String,
    /// Crops of `one`, in the order of the results.
    crops: Vec<Option<String>>,
}

impl CompetitorImages {
    /// Reads them from `folder`.
    pub fn read(
        results: &Results,
        competitor: &Competitor,
        folder: &Path,
    ) -> Result<Self, ReportError> {
        let images = &competitor.images;
        let uri = |name: &str| read(&folder.join(name)).map(|bytes| data_uri(&bytes));
        let picture = Picture::read(&folder.join(&images.one_png))?;
        let crops = results.crops.iter().map(|crop| {
            let cropped = picture.cropped(crop);
            // An empty one lies outside.
            match cropped.width.min(cropped.height) {
                0 => Ok(None),
                _ => cropped.to_png().map(|png| Some(data_uri(&png))),
            }
        });
        let crops = crops.collect::<Result<_, _>>()?;
        // An accuracy study has dozens of competitors: a page with all of their means would be too large to open.
        let with_mean = results.conditions.repetitions > 1 && results.kind == StudyKind::Compare;
        Ok(Self {
            one: uri(&images.one_png)?,
            mean: if with_mean {
                Some(uri(&images.png)?)
            } else {
                None
            },
            error: uri(&images.error_png)?,
            crops,
        })
    }
}

/// All sections with images.
pub fn sections(results: &Results, images: &[CompetitorImages]) -> Markup {
    let repetitions = results.conditions.repetitions;
    html! {
        section id="images" style=(format!("--ratio: {} / {}", results.scene.width, results.scene.height)) {
            h2 { "Images" }
            (slider(results))
            h3 { "Side by side" }
            p.note {
                "One repetition of each: the noise that one budget leaves. Zoom and position are shared by all images: wheel or "
                kbd { "+" } " " kbd { "−" } ", drag or arrow keys, double click or " kbd { "0" } " to reset."
            }
            div.gallery { @for (competitor, uris) in results.competitors.iter().zip(images) {
                figure {
                    (view(results, &competitor.name, &uris.one, "one repetition", true))
                    figcaption { (competitor.name) " " a href=(competitor.images.exr) { "EXR" } }
                }
            } }
            @if !results.crops.is_empty() { (crops(results, images)) }
            h3 { "Errors" }
            p.note {
                "Of the same repetitions, against the reference: the relative error |x − r| / m in each pixel. What is beyond the "
                "scale has its last colour."
            }
            div.gallery { @for (competitor, uris) in results.competitors.iter().zip(images) {
                figure {
                    (view(results, &competitor.name, &uris.error, "error", false))
                    (scale(competitor.images.error_scale))
                    figcaption { (competitor.name) }
                }
            } }
            @if images.iter().any(|uris| uris.mean.is_some()) {
                details {
                    summary { "The mean of all " (counted(repetitions.into(), "repetition")) }
                    div.gallery { @for (competitor, uris) in results.competitors.iter().zip(images) {
                        @if let Some(mean) = &uris.mean {
                            figure {
                                (view(results, &competitor.name, mean, "mean of all repetitions", false))
                                figcaption { (competitor.name) }
                            }
                        }
                    } }
                }
            }
        }
    }
}

/// A window on an image.
fn view(results: &Results, name: &str, uri: &str, kind: &str, marked: bool) -> Markup {
    let (width, height) = (results.scene.width, results.scene.height);
    let share = |part: u32, whole: u32| f64::from(part) / f64::from(whole.max(1)) * 100.0;
    html! {
        div.view tabindex="0" role="group" aria-label=(format!("{name}, {kind}: zoomable")) {
            div.layer {
                img src=(uri) alt=(format!("{name}, {kind}")) data-name=(name) data-kind=(kind)
                    width=(width) height=(height) draggable="false";
                @if marked { @for (index, crop) in results.crops.iter().enumerate() {
                    span.mark style=(format!(
                        "left:{:.3}%;top:{:.3}%;width:{:.3}%;height:{:.3}%;--mark:{}",
                        share(crop.x, width), share(crop.y, height), share(crop.width, width), share(crop.height, height),
                        mark(index)
                    )) { b { (index + 1) } }
                } }
            }
        }
    }
}

fn mark(index: usize) -> &'static str {
    MARKS[index % MARKS.len()]
}

/// Two images, one over the other; the script fills it.
fn slider(results: &Results) -> Markup {
    if results.competitors.len() < 2 {
        return html! {};
    }
    let chooser = |label: &str, id: &str| {
        html! {
            label { (label) " " select id=(id) {} }
        }
    };
    html! {
        div #compare hidden {
            div.controls {
                (chooser("Left", "left"))
                (chooser("Right", "right"))
                span.buttons role="group" aria-label="Zoom of all images" {
                    button type="button" data-zoom="out" aria-label="Zoom out" { "−" }
                    output #zoom-level aria-live="polite" { "100 %" }
                    button type="button" data-zoom="in" aria-label="Zoom in" { "+" }
                    button type="button" data-zoom="reset" { "Reset" }
                }
            }
            div.view.split tabindex="0" role="group" aria-label="Two images with a slider: zoomable" {
                div.pane { div.layer { img #left-image alt="" draggable="false"; } }
                div.pane.right { div.layer { img #right-image alt="" draggable="false"; } }
                span.tag #left-tag {}
                span.tag.right #right-tag {}
                div #handle tabindex="0" role="slider" aria-label="Where the left image ends" aria-valuemin="0"
                    aria-valuemax="100" aria-valuenow="50" {}
            }
        }
        noscript { p.note { "The slider and the zoom need JavaScript." } }
    }
}

/// One row for each crop: the same spot of all competitors.
fn crops(results: &Results, images: &[CompetitorImages]) -> Markup {
    html! {
        h3 { "Enlarged crops" }
        @for (index, crop) in results.crops.iter().enumerate() {
            div.crops style=(format!("--mark:{}", mark(index))) {
                @for (competitor, uris) in results.competitors.iter().zip(images) {
                    @if let Some(Some(uri)) = uris.crops.get(index) {
                        figure {
                            img src=(uri) width=(crop.width) height=(crop.height)
                                alt=(format!("{}, crop {}", competitor.name, index + 1));
                            figcaption { b { (index + 1) } " " (competitor.name) }
                        }
                    }
                }
            }
            p.note {
                "Crop " (index + 1) ": " (crop.width) " × " (crop.height) " pixels from column " (crop.x) " and row " (crop.y)
                ", without smoothing."
            }
        }
    }
}

/// The colours of errors with numbers. A colour stands for the root of the relative squared error, linearly.
fn scale(relative_squared_error: f64) -> Markup {
    const STEPS: u32 = 12;
    const NUMBERS: u32 = 4;
    let top = relative_squared_error.max(0.0).sqrt();
    let colours = (0..=STEPS).map(|step| {
        let [r, g, b] = false_colour::colour(f64::from(step) / f64::from(STEPS));
        format!("#{r:02x}{g:02x}{b:02x}")
    });
    let colours: Vec<String> = colours.collect();
    html! {
        div.scale role="img" aria-label=(format!("Colours from 0, black, to a relative error of {}, light yellow", significant(top, 2))) {
            div style=(format!("background:linear-gradient(90deg,{})", colours.join(","))) {}
            span { @for number in 0..=NUMBERS {
                i { (short(top * f64::from(number) / f64::from(NUMBERS), 3)) }
            } }
        }
    }
}

/// The colour of a competitor in plots, as a dot before its name.
pub fn swatch(index: usize) -> Markup {
    html! { span.swatch style=(format!("background:{}", colour(index))) {} }
}
