// A camera that circles the model, moved by pointers, fingers, wheel and keys.

const CLICK_PIXELS = 5, NEAREST_POLE = 0.05;  // radians

class Orbit {
  /** `up`: unit vector, the scene's. `radius`: of the model around the origin. */
  constructor(THREE, element, up, radius, changed) {
    this.THREE = THREE;
    this.element = element;
    this.up = up;
    this.radius = radius;
    this.changed = changed;
    this.clicked = () => {};
    const across = Math.abs(up.x) < 0.9 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0);
    this.east = across.cross(up).normalize();
    this.north = new THREE.Vector3().crossVectors(up, this.east);
    this.target = new THREE.Vector3();
    this.azimuth = 0;
    this.polar = 1.2;
    this.distance = 4 * radius;
    this.pointers = new Map();
    this.listen();
  }

  position() {
    const flat = Math.sin(this.polar) * this.distance;
    return this.target.clone().addScaledVector(this.up, Math.cos(this.polar) * this.distance)
      .addScaledVector(this.east, Math.cos(this.azimuth) * flat)
      .addScaledVector(this.north, Math.sin(this.azimuth) * flat);
  }

  orientation() {
    const matrix = new this.THREE.Matrix4().lookAt(this.position(), this.target, this.up);
    return new this.THREE.Quaternion().setFromRotationMatrix(matrix);
  }

  /** Looks at the target from the side of a place, at a distance of its own. */
  lookFrom(place, distance = place.distanceTo(this.target)) {
    const d = place.clone().sub(this.target);
    const length = Math.max(d.length(), 1e-9);
    this.polar = Math.acos(Math.min(Math.max(d.dot(this.up) / length, -1), 1));
    this.azimuth = Math.atan2(d.dot(this.north), d.dot(this.east));
    this.distance = distance;
    this.rotate(0, 0);
  }

  rotate(right, down) {
    this.azimuth -= right;
    this.polar = Math.min(Math.max(this.polar - down, NEAREST_POLE), Math.PI - NEAREST_POLE);
    this.changed();
  }

  zoom(factor) {
    this.distance = Math.min(Math.max(this.distance * factor, 0.05 * this.radius), 60 * this.radius);
    this.changed();
  }

  /** By pixels of the element. */
  pan(right, down) {
    const turn = this.orientation(), scale = 0.7 * this.distance / this.element.clientHeight;
    const move = new this.THREE.Vector3(-right * scale, down * scale, 0).applyQuaternion(turn);
    this.target.add(move);
    this.changed();
  }

  listen() {
    const on = (name, action, options) => this.element.addEventListener(name, action, options);
    on("pointerdown", event => this.down(event));
    on("pointermove", event => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) on(name, event => this.lift(event));
    on("wheel", event => {
      event.preventDefault();
      this.zoom(Math.exp(event.deltaY * (event.deltaMode ? 0.05 : 0.0015)));
    }, { passive: false });
    on("contextmenu", event => event.preventDefault());
  }

  down(event) {
    this.element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.travelled = this.pointers.size > 1 ? Infinity : 0;
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = { x: event.clientX, y: event.clientY };
    const dx = now.x - before.x, dy = now.y - before.y;
    this.travelled += Math.hypot(dx, dy);
    if (this.pointers.size === 2) {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)[1];
      const gap = p => Math.max(Math.hypot(p.x - other.x, p.y - other.y), 1);
      this.zoom(gap(before) / gap(now));
      this.pan(dx / 2, dy / 2);
    } else if (this.travelled > CLICK_PIXELS) {
      if (event.shiftKey || event.buttons & 6) this.pan(dx, dy);
      else this.rotate(0.008 * dx, 0.008 * dy);
    }
    this.pointers.set(event.pointerId, now);
  }

  lift(event) {
    if (!this.pointers.delete(event.pointerId)) return;
    if (event.type === "pointerup" && this.travelled <= CLICK_PIXELS) this.clicked(event);
  }

  /** Does a key, and says whether it means something. */
  key(event) {
    const turn = 0.12, step = 30;
    const arrows = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (event.ctrlKey || event.altKey || event.metaKey) return false;
    const arrow = arrows[event.key];
    if (arrow && event.shiftKey) this.pan(step * arrow[0], step * arrow[1]);
    else if (arrow) this.rotate(turn * arrow[0], turn * arrow[1]);
    else if (event.key === "+" || event.key === "=") this.zoom(1 / 1.15);
    else if (event.key === "-" || event.key === "_") this.zoom(1.15);
    else return false;
    return true;
  }
}
