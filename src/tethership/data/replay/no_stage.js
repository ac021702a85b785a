// In place of a stage where the browser cannot draw in space: the numbers of the time, and a sentence.

const NO_SPACE =
  "The view in space needs WebGL 2, which this browser does not offer here (it may be switched off, or lack a graphics " +
  "driver). Numbers, histories and player work without it.";

class NoStage {
  constructor(parent, flight, tracks) {
    this.flight = flight;
    this.tracks = tracks;
    this.parent = parent;
    this.frames = 0;
    this.blind = true;
    this.rig = { name: "", choose: () => {}, copy: () => {} };
    const words = document.createElement("p");
    words.className = "sentence";
    words.textContent = document.querySelector(".sentence") ? "" : NO_SPACE; // said once
    parent.replaceChildren(words);
    parent.parentElement.classList.add("blind");
  }

  resize() {}

  place(time) {
    this.now = this.tracks.at(time);
  }

  render() {
    this.frames += 1;
  }
}

// Whether the browser can draw in space; asked once, for a refused context says so on the console each time.
const canDrawInSpace = () => {
  const canvas = document.createElement("canvas");
  return Boolean(window.WebGL2RenderingContext && canvas.getContext("webgl2"));
};
