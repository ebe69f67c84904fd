// A thin wrapper of uPlot: theme colours, simulated time along x, and a logarithmic axis that survives an exact zero.

import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { format } from '../session/numbers';

export interface Trace {
  label: string;
  colour: string;
  dash?: number[];
  width?: number;
}

export interface PlotOptions {
  traces: readonly Trace[];
  unit: string;
  logarithmic: boolean;
  ink: string;
  line: string;
}

/** A residual of exactly zero has no logarithm and is drawn at this value, a hundredth of the roundoff of a metre. */
const FLOOR = 1e-18;

export class Plot {
  private readonly plot: uPlot;

  constructor(
    private readonly host: HTMLElement,
    private readonly options: PlotOptions,
  ) {
    this.plot = new uPlot(
      this.uplotOptions(),
      [[], ...options.traces.map(() => [])] as uPlot.AlignedData,
      host,
    );
  }

  private uplotOptions(): uPlot.Options {
    const { traces, logarithmic, ink, line } = this.options;
    const axis: uPlot.Axis = {
      stroke: ink,
      font: '10px system-ui, sans-serif',
      ticks: { show: false },
      grid: { stroke: line, width: 1 },
      gap: 4,
    };
    return {
      width: Math.max(80, this.host.clientWidth),
      height: Math.max(60, this.host.clientHeight),
      pxAlign: 0,
      padding: [6, 4, 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        // a single sample gets an axis of one second
        x: { time: false, range: (_plot, min, max) => [min ?? 0, max > min ? max : (min ?? 0) + 1] },
        y: logarithmic
          ? { distr: 3, log: 10, range: (_plot, min, max) => decades(min, max) }
          : { range: (_plot, min, max) => room(min, max) },
      },
      axes: [
        {
          ...axis,
          size: 18,
          space: 56,
          values: (_plot, ticks) => ticks.map((tick) => `${format(tick)} s`),
        },
        {
          ...axis,
          size: 46,
          space: 26,
          // uPlot's own choice for a logarithmic axis draws a line for every digit and labels by its own filter
          ...(logarithmic
            ? {
                splits: (_plot, _axis, low, high) => everyFewDecades(low, high),
                filter: (_plot, splits) => splits,
              }
            : {}),
          values: (_plot, ticks) => ticks.map((tick) => (logarithmic ? power(tick) : format(tick))),
        },
      ],
      series: [
        {},
        ...traces.map(({ colour, dash, width }) => ({
          stroke: colour,
          width: width ?? 1.5,
          ...(dash ? { dash } : {}),
          points: { show: false },
        })),
      ],
    };
  }

  show(columns: (number | null)[][]): void {
    const [time, ...values] = columns;
    const shown = this.options.logarithmic
      ? values.map((column) => column.map((value) => (value === null ? null : Math.max(FLOOR, value))))
      : values;
    this.plot.setData([time, ...shown] as uPlot.AlignedData);
  }

  resize(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width > 0 && height > 0 && (width !== this.plot.width || height !== this.plot.height)) {
      this.plot.setSize({ width, height });
    }
  }

  destroy(): void {
    this.plot.destroy();
  }
}

/** Whole decades, at least three, so that roundoff does not fill the plot. */
function decades(min: number | null, max: number | null): [number, number] {
  if (min === null || max === null || !(max > 0)) return [1e-16, 1];
  const high = Math.ceil(Math.log10(max) + 0.1);
  const low = Math.min(Math.floor(Math.log10(Math.max(min, FLOOR)) - 0.1), high - 3);
  return [10 ** low, 10 ** high];
}

/** A margin of a tenth above and below; for a constant a margin of its own size. */
function room(min: number | null, max: number | null): [number, number] {
  if (min === null || max === null) return [0, 1];
  const span = max - min;
  const air = span > 1e-12 * Math.max(Math.abs(min), Math.abs(max)) ? 0.1 * span : 0.1 * (Math.abs(max) || 1);
  return [min - air, max + air];
}

/** At most five lines: in a range of many decades, lines are several decades apart. */
function everyFewDecades(low: number, high: number): number[] {
  const [first, last] = [Math.ceil(Math.log10(low) - 1e-9), Math.floor(Math.log10(high) + 1e-9)];
  const every = Math.max(1, Math.ceil((last - first) / 4));
  const splits = [];
  for (let exponent = Math.ceil(first / every) * every; exponent <= last; exponent += every)
    splits.push(10 ** exponent);
  return splits;
}

function power(tick: number): string {
  return format(tick, 2).replace(/^1(\.0)?·/, '');
}
