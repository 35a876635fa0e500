// What the page uses of ECharts; README.md has the command that bundles it.
export { init } from "echarts/core";
import { use } from "echarts/core";
import { CustomChart, LineChart, ScatterChart } from "echarts/charts";
import { DataZoomInsideComponent, GraphicComponent, GridComponent } from "echarts/components";
import { SVGRenderer } from "echarts/renderers";
use([CustomChart, LineChart, ScatterChart, DataZoomInsideComponent, GraphicComponent, GridComponent, SVGRenderer]);
