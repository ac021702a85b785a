// Words in the scene: HTML above the canvas, each at a point of the ground axes.

const ROOM = 12; // to the right of a label [px]

class Labels {
  constructor(parent) {
    this.parent = parent;
    this.all = [];
  }

  add(words, kind) {
    const element = document.createElement("span");
    element.className = `label ${kind}`;
    this.parent.append(element);
    const label = {
      element,
      point: new THREE.Vector3(),
      shown: true,
      words: null,
      text(next) {
        if (next === this.words) return;
        this.words = next;
        element.textContent = next;
        this.width = element.offsetWidth;
      },
    };
    label.text(words);
    this.all.push(label);
    return label;
  }

  place(camera, width, height) {
    for (const label of this.all) {
      const spot = toScene(label.point).project(camera);
      const seen = label.shown && spot.z < 1 && Math.abs(spot.x) < 1.02 && Math.abs(spot.y) < 1.02;
      label.element.style.visibility = seen ? "visible" : "hidden";
      if (!seen) continue;
      const x = Math.min(0.5 * (1 + spot.x) * width, width - label.width - ROOM);
      const y = 0.5 * (1 - spot.y) * height;
      label.element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    }
  }
}
