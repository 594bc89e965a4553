// What the page uses of ECharts.
import { LineChart, ParallelChart, ScatterChart } from "echarts/charts";
import {
  GridComponent, LegendComponent, MarkAreaComponent, MarkLineComponent, ParallelComponent, TitleComponent, TooltipComponent,
} from "echarts/components";
import { use } from "echarts/core";
import { LabelLayout } from "echarts/features";
import { SVGRenderer } from "echarts/renderers";

use([
  GridComponent, LabelLayout, LegendComponent, LineChart, MarkAreaComponent, MarkLineComponent, ParallelChart, ParallelComponent, ScatterChart,
  SVGRenderer, TitleComponent, TooltipComponent,
]);
export { init } from "echarts/core";
