// A signal: a part of the page announces a change to the parts that listen, without importing them.

/** Calls its listeners in the order in which they were added. */
export class Signal<Values extends unknown[] = []> {
  private readonly listeners: ((...values: Values) => void)[] = [];

  listen(listener: (...values: Values) => void): void {
    this.listeners.push(listener);
  }

  send(...values: Values): void {
    for (const listener of this.listeners) listener(...values);
  }
}
