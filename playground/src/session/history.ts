// The data of the plots: samples of the last stretch of simulated time, in a ring of fixed size.

/** One value per trace, at one time; NaN where a trace has no value (the ghost, when there is none). */
export type Sample = readonly number[];

export class History {
  private readonly columns: Float64Array[];
  private start = 0;
  private length = 0;

  constructor(
    readonly traces: number,
    readonly capacity = 900,
  ) {
    this.columns = Array.from({ length: traces }, () => new Float64Array(capacity));
  }

  get size(): number {
    return this.length;
  }

  clear(): void {
    this.start = 0;
    this.length = 0;
  }

  push(sample: Sample): void {
    const at = (this.start + this.length) % this.capacity;
    for (let trace = 0; trace < this.traces; trace += 1)
      this.columns[trace][at] = sample[trace] ?? Number.NaN;
    if (this.length < this.capacity) this.length += 1;
    else this.start = (this.start + 1) % this.capacity;
  }

  /** The newest value of a trace; NaN if the trace has none. */
  last(index: number): number {
    if (this.length === 0) return Number.NaN;
    return this.columns[index][(this.start + this.length - 1) % this.capacity];
  }

  /** One trace, oldest value first; null stands for a missing value, which uPlot draws as a gap. */
  trace(index: number): (number | null)[] {
    const column = this.columns[index];
    const values: (number | null)[] = new Array(this.length);
    for (let i = 0; i < this.length; i += 1) {
      const value = column[(this.start + i) % this.capacity];
      values[i] = Number.isFinite(value) ? value : null;
    }
    return values;
  }
}
