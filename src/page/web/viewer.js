// The picture of the model and its cameras.

const FLIGHT_MS = 700, FIELD = 32;  // degrees, of the circling camera

/** WebGL 2; smooth edges and fine pixels only where there is a graphics device, for software takes seconds with them. */
function contextOf(canvas) {
  const attributes = { alpha: true, antialias: true, failIfMajorPerformanceCaveat: true };
  const context = canvas.getContext("webgl2", attributes)
    || canvas.getContext("webgl2", { ...attributes, antialias: false, failIfMajorPerformanceCaveat: false });
  if (!context) throw new Error("the browser gives no WebGL 2");
  return context;
}

class Viewer {
  /** `texture`: the image that the model's places lie on, or nothing. */
  constructor(THREE, data, numbers, texture, colourOf) {
    this.THREE = THREE;
    this.canvas = byId("canvas");
    this.numbers = numbers;
    this.through = -1;  // the camera that is looked through
    const context = contextOf(this.canvas);
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, context });
    this.renderer.debug.checkShaderErrors = false;  // asking makes the browser wait
    this.renderer.setPixelRatio(context.getContextAttributes().antialias ? Math.min(devicePixelRatio, 2) : 1);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(FIELD, 1, 0.01, 100);
    this.addModel(data.model);
    this.addTexture(texture);
    this.photographs = new Photographs(THREE, data.views, world => this.local(world), colourOf);
    this.scene.add(this.photographs.group);
    this.addLights();
    this.orbit = new Orbit(THREE, this.canvas, new THREE.Vector3(...data.up), 1, () => this.leave());
    this.orbit.clicked = event => this.click(event);
    this.first = data.first_view;
    this.reset();
    this.canvas.addEventListener("pointermove", event => this.point(event));
    this.canvas.addEventListener("pointerleave", () => this.point(null));
    this.canvas.addEventListener("webglcontextrestored", () => this.draw());
    new ResizeObserver(() => this.resize()).observe(byId("viewport"));
    this.resize();
  }

  /** The model is there; photographs come when it has been drawn. */
  drawn() {
    return new Promise(done => {
      this.onDrawn = done;
      this.draw();
    });
  }

  /** From the world to the picture, in which the model has radius 1 around the origin. */
  local(world) {
    return world.map((w, axis) => (w - this.middle[axis]) / this.radius);
  }

  addModel(table) {
    const THREE = this.THREE, codes = this.numbers.position;
    const high = [0, 0, 0];
    for (let i = 0; i < codes.length; i += 3)
      for (let axis = 0; axis < 3; ++axis)
        if (codes[i + axis] > high[axis]) high[axis] = codes[i + axis];
    this.middle = high.map((h, axis) => table.low[axis] + table.step * h / 2);
    let farthest = 0;  // from the middle, in steps, squared
    for (let i = 0; i < codes.length; i += 3) {
      const x = codes[i] - high[0] / 2, y = codes[i + 1] - high[1] / 2, z = codes[i + 2] - high[2] / 2;
      farthest = Math.max(farthest, x * x + y * y + z * z);
    }
    this.radius = table.step * Math.sqrt(farthest) || 1;
    const scale = table.step / this.radius, positions = new Float32Array(codes.length);
    for (let i = 0; i < codes.length; i += 3)
      for (let axis = 0; axis < 3; ++axis) positions[i + axis] = scale * (codes[i + axis] - high[axis] / 2);
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    this.geometry.setIndex(new THREE.BufferAttribute(this.numbers.triangles, 1));
    this.geometry.setAttribute("normal", new THREE.BufferAttribute(normalsOf(codes, this.numbers.triangles), 3, true));
    this.plain = new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide });
    this.lit = new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide });
    this.clay = new THREE.MeshLambertMaterial({ color: 0xb9b2a6, side: THREE.DoubleSide });
    this.mesh = new THREE.Mesh(this.geometry, this.clay);
    this.scene.add(this.mesh);
  }

  addTexture(image) {
    if (!image) return;
    const THREE = this.THREE, texture = new THREE.Texture(image);
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.flipY = false;
    texture.needsUpdate = true;
    const { place } = this.numbers, places = new Float32Array(place.length);
    for (let i = 0; i < place.length; ++i) places[i] = place.step * place[i];
    this.geometry.setAttribute("uv", new THREE.BufferAttribute(places, 2));
    this.textured = new THREE.MeshBasicMaterial({ map: texture, side: THREE.DoubleSide });
  }

  /** A lamp at the viewer's shoulder, and light from all around. */
  addLights() {
    const lamp = new this.THREE.DirectionalLight(0xffffff, 2.3);
    lamp.position.set(-0.6, 0.8, 1);
    this.camera.add(lamp, lamp.target);
    lamp.target.position.set(0, 0, -1);
    this.scene.add(this.camera, new this.THREE.AmbientLight(0xffffff, 0.9));
  }

  show(layer) {
    const colours = layer.colours(this.numbers);
    if (colours) this.geometry.setAttribute("color", new this.THREE.BufferAttribute(colours, 3, true));
    this.mesh.material = layer.textured ? this.textured : !colours ? this.clay : layer.shaded ? this.lit : this.plain;
    this.draw();
  }

  showCameras(on) {
    this.camerasWanted = on;
    this.draw();
  }

  /** From beside the camera that shows the model best, and a little above. */
  reset() {
    this.leave();
    this.orbit.target.set(0, 0, 0);
    const start = (this.photographs.centres[this.first] || new this.THREE.Vector3(1, 0, 0)).clone();
    start.addScaledVector(this.orbit.up, 0.15 * start.length()).applyAxisAngle(this.orbit.up, 0.3);
    this.orbit.lookFrom(start, 1.15 / Math.sin(FIELD * Math.PI / 360) * this.narrowness());
  }

  /** On tall narrow elements the model needs more distance to fit. */
  narrowness() {
    return Math.max(1, this.canvas.clientHeight / Math.max(this.canvas.clientWidth, 1));
  }

  // What is looked through.

  /** Flies to a camera; -1: away from it. */
  lookThrough(i) {
    if (i === this.through) return;
    if (i < 0) this.leave();
    else this.flyFrom(i);
  }

  flyFrom(to) {
    this.flight = { start: performance.now(), position: this.camera.position.clone(), turn: this.camera.quaternion.clone(),
      projection: this.camera.projectionMatrix.clone() };
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) this.flight = null;
    this.through = to;
    this.throughChanged();
    this.draw();
  }

  /** The circling camera takes over, from where the camera stands that is looked through. */
  leave() {
    if (this.through >= 0) {
      const centre = this.photographs.centres[this.through];
      this.flyFrom(-1);
      this.orbit.target.set(0, 0, 0);
      this.orbit.lookFrom(centre);
    }
    this.draw();
  }

  throughChanged() {
    this.onThrough?.(this.through);
    this.placePhotograph();
  }

  placePhotograph() {
    const photograph = byId("photograph"), i = this.through;
    photograph.hidden = i < 0 || !this.photographs.views[i].jpeg;
    if (photograph.hidden) return;
    const { left, top, width, height } = this.photographs.rectangle(i, this.canvas.clientWidth, this.canvas.clientHeight);
    photograph.src = pictureOf(this.photographs.views[i]);
    photograph.style.cssText = `left: ${left}px; top: ${top}px; width: ${width}px; height: ${height}px`;
    this.blend();
  }

  blend() {
    const settled = !this.flight;
    byId("photograph").style.opacity = settled ? byId("opacity").value / 100 : 0;
  }

  // Pointers.

  viewAt(event) {
    if (!this.photographs.group.visible) return -1;
    const box = this.canvas.getBoundingClientRect();
    const place = new this.THREE.Vector2(2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height);
    const rays = new this.THREE.Raycaster();
    rays.setFromCamera(place, this.camera);
    const hit = rays.intersectObjects(this.photographs.planes)[0];
    return hit ? hit.object.userData.view : -1;
  }

  click(event) {
    const i = this.viewAt(event);
    if (i >= 0) this.lookThrough(i);
  }

  point(event) {
    const i = event && event.pointerType === "mouse" && !event.buttons ? this.viewAt(event) : -1;
    const label = byId("pointed");
    this.canvas.classList.toggle("pointing", i >= 0);
    label.hidden = i < 0;
    if (i < 0) return;
    label.textContent = this.photographs.views[i].name;
    label.style.left = event.offsetX + "px";
    label.style.top = event.offsetY + "px";
  }

  // Drawing, when something changed.

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.placePhotograph();
    this.draw();
  }

  draw() {
    this.frame ??= requestAnimationFrame(() => {
      this.frame = null;
      this.place();
      this.photographs.group.visible = this.photographs.loaded && this.camerasWanted && this.through < 0 && !this.flight;
      this.photographs.fade(this.camera.position);
      this.renderer.render(this.scene, this.camera);
      this.onDrawn?.();
      if (this.flight) this.draw();
    });
  }

  /** Where the camera belongs, or on its way there. */
  place() {
    const { clientWidth: width, clientHeight: height } = this.canvas, camera = this.camera, i = this.through;
    const position = i < 0 ? this.orbit.position() : this.photographs.centres[i];
    const turn = i < 0 ? this.orbit.orientation() : this.photographs.orientation(i);
    const far = position.length() + 100, near = Math.max(0.002, 0.2 * (position.length() - 1.2));
    camera.aspect = width / height;
    camera.near = near;
    camera.far = far;
    camera.updateProjectionMatrix();
    if (i >= 0) camera.projectionMatrix.copy(this.photographs.projection(i, width, height, near, far));
    camera.position.copy(position);
    camera.quaternion.copy(turn);
    if (this.flight) this.fly();
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  }

  fly() {
    const { start, position, turn, projection } = this.flight, camera = this.camera;
    const share = Math.min((performance.now() - start) / FLIGHT_MS, 1), eased = share * share * (3 - 2 * share);
    const length = position.length() + eased * (camera.position.length() - position.length());
    camera.position.lerpVectors(position, camera.position, eased).setLength(length);
    camera.quaternion.slerpQuaternions(turn, camera.quaternion, eased);
    camera.projectionMatrix.elements.forEach((to, k, all) => {
      all[k] = projection.elements[k] + eased * (to - projection.elements[k]);
    });
    if (share < 1) return;
    this.flight = null;
    this.blend();
    this.draw();
  }
}
