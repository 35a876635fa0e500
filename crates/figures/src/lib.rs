//! Draws figures as SVG: the charts of the report page, run by QuickJS without a browser. So a figure in a file is the
//! one on the page.

use std::io;

use rquickjs::{CatchResultExt, Context, Function, Object, Runtime};
use spindrift::report::figure_files::{draw_by, drawing_scripts};

/// What the scripts expect of a browser: the library of charts puts off work for animations, which a file has none of.
const BROWSER: &str = "globalThis.setTimeout = () => 0; globalThis.clearTimeout = () => {};";
/// Draws a list of figures given as JSON.
const DRAW: &str = "globalThis.drawAll = (text) => JSON.parse(text).map((figure) => svgText(figure, echarts));";

/// Makes this process write figures as SVG.
pub fn register() {
    draw_by(draw);
}

/// An SVG for each of the figures of the JSON list `figures`.
///
/// # Errors
/// What the scripts say, where they fail.
pub fn draw(figures: &str) -> Result<Vec<String>, String> {
    let [echarts, ours] = drawing_scripts().map_err(|error: io::Error| error.to_string())?;
    let failed = |error: rquickjs::Error| error.to_string();
    let runtime = Runtime::new().map_err(failed)?;
    let context = Context::full(&runtime).map_err(failed)?;
    context.with(|context| {
        let run = |text: String| context.eval::<(), _>(text).catch(&context).map_err(|error| error.to_string());
        run(BROWSER.to_owned())?;
        run(format!("{echarts};globalThis.echarts = echarts;"))?;
        run(format!("{ours}\n{DRAW}"))?;
        let globals: Object<'_> = context.globals();
        let draw: Function<'_> = globals.get("drawAll").catch(&context).map_err(|error| error.to_string())?;
        draw.call((figures,)).catch(&context).map_err(|error| error.to_string())
    })
}
