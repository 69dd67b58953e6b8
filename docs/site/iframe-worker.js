// The search runs in a worker, and browsers refuse workers to pages opened as files. There a hidden
// frame does the worker's work; as for a worker, what is said is copied.
if (location.protocol === "file:") {
  window.Worker = class {
    constructor(address) {
      const waiting = [];
      this.hear = (data) => waiting.push(data);
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      this.frame.addEventListener("load", () => {
        const inside = this.frame.contentWindow;
        inside.postMessage = (data) => this.say(structuredClone(data));
        const script = inside.document.createElement("script");
        script.src = new URL(address, location.href).href;
        script.onerror = (event) => this.onerror?.(event);
        script.onload = () => {
          this.hear = (data) => inside.onmessage({ data });
          waiting.splice(0).forEach(this.hear);
        };
        inside.document.body.append(script);
      }, { once: true });
      document.body.append(this.frame);
    }

    postMessage(data) {
      this.hear(structuredClone(data));
    }

    say(data) {
      setTimeout(() => this.onmessage?.({ data }));
    }

    terminate() {
      this.frame.remove();
    }
  };
}
