//! Plots of errors over time, both axes logarithmic, as SVG.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::ReportError;
use super::log_axis::LogAxis;
use super::numbers::short;
use crate::study::results::{Competitor, Results, Snapshot, StudyKind};
use crate::study::statistics::Interval;

/// Okabe and Ito's colours, which the colour-blind can tell apart, in an order that suits both light and dark paper.
const PALETTE: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#808080",
];
/// Axes and grid: between light and dark paper.
const GRID: RGBColor = RGBColor(128, 128, 128);
/// Pixels of a plot, before the page scales it.
const SIZE: (u32, u32) = (640, 420);
const FONT: &str = "system-ui, sans-serif";
const FONT_SIZE: i32 = 17;
/// Least distance of two labels' middles, pixels.
const LABEL_STEP: i32 = 20;
/// Characters of a label.
const LONGEST_LABEL: usize = 24;
/// Bands are shown down to this share of the estimate.
const LOWEST_SHOWN: f64 = 0.25;

/// The colour of a competitor, as `#rrggbb`.
pub fn colour(index: usize) -> &'static str {
    PALETTE[index % PALETTE.len()]
}

/// A plot and what it shows.
#[derive(Clone, Debug)]
pub struct Plot {
    /// What is drawn over what.
    pub title: String,
    /// The drawing.
    pub svg: String,
}

/// One measure over one kind of cost.
struct Axes {
    title: &'static str,
    cost: &'static str,
    /// Numbers that have room beside each other below the axis.
    most_ticks: usize,
    error: &'static str,
    cost_of: fn(&Snapshot) -> Option<f64>,
    error_of: fn(&Snapshot) -> Interval,
}

const AXES: [Axes; 3] = [
    Axes {
        title: "Relative MSE over time",
        cost: "seconds",
        most_ticks: 8,
        error: "relative MSE",
        cost_of: |snapshot| Some(snapshot.seconds),
        error_of: |snapshot| snapshot.errors.relative_mse,
    },
    Axes {
        title: "RMSE over time",
        cost: "seconds",
        most_ticks: 8,
        error: "RMSE",
        cost_of: |snapshot| Some(snapshot.seconds),
        error_of: |snapshot| snapshot.errors.rmse,
    },
    Axes {
        title: "Relative MSE over rays",
        cost: "rays",
        most_ticks: 4,
        error: "relative MSE",
        cost_of: |snapshot| snapshot.rays,
        error_of: |snapshot| snapshot.errors.relative_mse,
    },
];

/// The points of one competitor.
struct Series<'a> {
    name: &'a str,
    colour: RGBColor,
    points: Vec<(f64, Interval)>,
}

/// All plots: of a comparison relative MSE and RMSE over time and relative MSE over rays; of an accuracy study relative
/// MSE over time, one plot for each setting that is varied.
pub fn plots(results: &Results) -> Result<Vec<Plot>, ReportError> {
    let mut plots = Vec::new();
    for (title, axes, competitors) in wanted(results) {
        let series: Vec<Series> = competitors
            .into_iter()
            .enumerate()
            .map(|(index, competitor)| series(competitor, colour(index), axes))
            .filter(|series| !series.points.is_empty())
            .collect();
        if series.iter().any(|series| series.points.len() > 1) {
            let svg = draw(axes, &series).map_err(|message| ReportError::Encode {
                what: "a plot",
                message,
            })?;
            plots.push(Plot { title, svg });
        }
    }
    Ok(plots)
}

/// Titles, axes and competitors of all plots.
fn wanted(results: &Results) -> Vec<(String, &'static Axes, Vec<&Competitor>)> {
    let all = &results.competitors;
    if results.kind == StudyKind::Compare {
        let of_all = |axes: &'static Axes| (axes.title.to_owned(), axes, all.iter().collect());
        return AXES.iter().map(of_all).collect();
    }
    let axis = |competitor: &Competitor| Some(competitor.verdict.as_ref()?.axis.clone());
    let mut names: Vec<String> = all.iter().filter_map(axis).collect();
    names.dedup();
    let of_axis = names.into_iter().map(|name| {
        let baseline = all.iter().take(1);
        let others = all
            .iter()
            .filter(|&other| axis(other).as_ref() == Some(&name));
        (
            format!("{name}: {}", AXES[0].title),
            &AXES[0],
            baseline.chain(others).collect(),
        )
    });
    of_axis.collect()
}

fn series<'a>(competitor: &'a Competitor, colour: &str, axes: &Axes) -> Series<'a> {
    let points = competitor.snapshots.iter().filter_map(|snapshot| {
        let cost = (axes.cost_of)(snapshot).filter(|cost| cost.is_finite() && *cost > 0.0)?;
        let error = (axes.error_of)(snapshot);
        // Nothing else can be drawn on a logarithmic axis.
        (error.estimate.is_finite() && error.estimate > 0.0).then_some((cost, error))
    });
    let channel = |at: usize| u8::from_str_radix(&colour[at..at + 2], 16).unwrap_or(128);
    Series {
        name: &competitor.name,
        colour: RGBColor(channel(1), channel(3), channel(5)),
        points: points.collect(),
    }
}

fn draw(axes: &Axes, all: &[Series]) -> Result<String, String> {
    let points = || all.iter().flat_map(|series| &series.points);
    let costs = LogAxis::around(points().map(|point| point.0), axes.most_ticks);
    let errors = points().flat_map(|(_, error)| {
        let (low, high) = error.bounds.unwrap_or((error.estimate, error.estimate));
        // A lower end near 0 would stretch the axis without limit.
        [low.max(error.estimate * LOWEST_SHOWN), error.estimate, high]
    });
    let errors = LogAxis::around(errors, 9);
    let longest = all
        .iter()
        .map(|series| shortened(series.name).chars().count());
    let label_width = longest.max().unwrap_or(0) as u32 * 9 + 24;
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        let mut chart = ChartBuilder::on(&root)
            .margin(8)
            .margin_right(label_width)
            .x_label_area_size(52)
            .y_label_area_size(84)
            .build_cartesian_2d(costs, errors)
            .map_err(message)?;
        draw_grid(&mut chart, axes).map_err(message)?;
        for series in all {
            draw_series(&mut chart, series).map_err(message)?;
        }
        let ends = all.iter().filter_map(|series| {
            let (cost, error) = series.points.last()?;
            Some((chart.backend_coord(&(*cost, error.estimate)), series))
        });
        draw_labels(&root, ends.collect()).map_err(message)?;
        root.present().map_err(message)?;
    }
    Ok(svg)
}

fn message(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn shortened(name: &str) -> String {
    if name.chars().count() <= LONGEST_LABEL {
        return name.to_owned();
    }
    let start = name.chars().take(LONGEST_LABEL - 1);
    start.chain(['…']).collect()
}

type Refused = DrawingAreaErrorKind<std::io::Error>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<LogAxis, LogAxis>>;

fn draw_grid(chart: &mut Chart, axes: &Axes) -> Result<(), Refused> {
    let text = (FONT, FONT_SIZE).into_font().color(&GRID);
    let label = |value: &f64| short(*value, 2);
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID.mix(0.25))
        .axis_style(GRID)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .label_style(text.clone())
        .axis_desc_style(text)
        .x_desc(axes.cost)
        .y_desc(axes.error)
        .draw()
}

fn draw_series(chart: &mut Chart, series: &Series) -> Result<(), Refused> {
    let with_bounds = series.points.iter().filter_map(|(cost, error)| {
        let (low, high) = error.bounds?;
        Some((*cost, low, high))
    });
    let band: Vec<(f64, f64, f64)> = with_bounds.collect();
    if band.len() > 1 {
        let upper = band.iter().map(|&(cost, _, high)| (cost, high));
        let lower = band.iter().rev().map(|&(cost, low, _)| (cost, low));
        let outline: Vec<(f64, f64)> = upper.chain(lower).collect();
        chart.draw_series([Polygon::new(outline, series.colour.mix(0.2))])?;
    }
    let points = series.points.iter();
    let points: Vec<(f64, f64)> = points
        .map(|(cost, error)| (*cost, error.estimate))
        .collect();
    let circle = |&point: &(f64, f64)| Circle::new(point, 4, series.colour.filled());
    chart.draw_series(points.iter().map(circle))?;
    chart.draw_series(LineSeries::new(points, series.colour.stroke_width(2)))?;
    Ok(())
}

/// Names at the ends of their lines, moved apart where they would overlap.
fn draw_labels(
    root: &DrawingArea<SVGBackend, Shift>,
    mut ends: Vec<((i32, i32), &Series)>,
) -> Result<(), Refused> {
    ends.sort_by_key(|((_, y), _)| *y);
    let left = ends.iter().map(|((x, _), _)| x + 16).max().unwrap_or(0);
    let text = (FONT, FONT_SIZE).into_font().color(&GRID);
    let text = text.pos(Pos::new(HPos::Left, VPos::Center));
    let mut free = LABEL_STEP;
    for ((x, y), series) in ends {
        let at = y.max(free);
        free = at + LABEL_STEP;
        let leader = [(x + 5, y), (left - 3, at)];
        root.draw(&PathElement::new(leader, series.colour.stroke_width(1)))?;
        root.draw(&Text::new(shortened(series.name), (left, at), text.clone()))?;
    }
    Ok(())
}
