// The scene's cameras: pyramids with their photographs in the picture, and looking through one of them.

const CORNERS = [[0, 0], [1, 0], [1, 1], [0, 1]];
const pictureOf = view => view.jpeg ? "data:image/jpeg;base64," + view.jpeg : "";

/** The direction, in the camera's frame at depth 1, of a place on the photograph in shares of its sides. */
function rayOf(view, [x, y]) {
  const down = (y * view.size[1] - 0.5 - view.principal[1]) / view.focal[1];
  return [(x * view.size[0] - 0.5 - view.principal[0] - view.skew * down) / view.focal[0], down, 1];
}

function median(values) {
  const sorted = Float64Array.from(values).sort();
  return sorted.length ? sorted[sorted.length >> 1] : 0;
}

class Photographs {
  /** `local`: from the world to the picture's frame. `colourOf(i)`: of a camera's lines, a CSS colour. */
  constructor(THREE, views, local, colourOf) {
    this.THREE = THREE;
    this.views = views;
    this.group = new THREE.Group();
    this.centres = views.map(view => new THREE.Vector3(...local(view.centre)));
    this.planes = [];
    const depth = this.depth();
    const lines = [], colours = [];
    views.forEach((view, i) => {
      const corners = CORNERS.map(corner => this.place(i, rayOf(view, corner), depth));
      const colour = new THREE.Color(colourOf(i));
      const line = (a, b) => {
        lines.push(...a, ...b);
        colours.push(...colour.toArray(), ...colour.toArray());
      };
      corners.forEach((corner, c) => {
        line(this.centres[i].toArray(), corner);
        line(corner, corners[(c + 1) % 4]);
      });
      this.addPlane(i, corners);
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(lines, 3));
    geometry.setAttribute("color", new THREE.Float32BufferAttribute(colours, 3));
    this.group.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true })));
  }

  /** How deep pyramids are: small beside the way to the model, and such that neighbours stand apart. */
  depth() {
    const way = median(this.centres.map(c => c.length()));
    const gaps = this.centres.map(a => Math.min(...this.centres.filter(b => b !== a).map(b => a.distanceTo(b))));
    const wide = median(this.views.map(v => Math.max(v.size[0] / v.focal[0], v.size[1] / v.focal[1])));
    const gap = median(gaps.filter(isFinite));
    return Math.min(0.2 * way, gap > 0 && wide > 0 ? 0.8 * gap / wide : Infinity) || 0.1;
  }

  /** A place in the picture's frame, of a direction in a camera's. */
  place(i, ray, depth) {
    const rows = this.views[i].rotation;
    return this.centres[i].toArray().map((c, axis) =>
      c + depth * (rows[0][axis] * ray[0] + rows[1][axis] * ray[1] + rows[2][axis] * ray[2]));
  }

  addPlane(i, corners) {
    const THREE = this.THREE;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners.flat(), 3));
    geometry.setAttribute("uv", new THREE.Float32BufferAttribute([0, 1, 1, 1, 1, 0, 0, 0], 2));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const material = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, transparent: true, depthWrite: false, color: 0x888888 });
    const plane = new THREE.Mesh(geometry, material);
    plane.userData.view = i;
    this.planes.push(plane);
    this.group.add(plane);
  }

  /** Loads the photographs, without which the cameras are not drawn; `changed` is called when all are there. */
  async load(changed) {
    await Promise.all(this.views.map(async (view, i) => {
      if (!view.jpeg) return;
      const image = new Image();
      image.src = pictureOf(view);
      await image.decode();
      const texture = new this.THREE.Texture(image);
      texture.colorSpace = this.THREE.SRGBColorSpace;
      texture.needsUpdate = true;
      Object.assign(this.planes[i].material, { map: texture, needsUpdate: true });
      this.planes[i].material.color.set(0xffffff);
    }));
    this.loaded = true;
    changed();
  }

  /** Photographs that stand between a place and the model, with their backs to it, are nearly clear. */
  fade(place) {
    this.planes.forEach((plane, i) => {
      const ahead = this.views[i].rotation[2], centre = this.centres[i];
      const behind = ahead[0] * (centre.x - place.x) + ahead[1] * (centre.y - place.y) + ahead[2] * (centre.z - place.z) > 0;
      plane.material.opacity = !plane.material.map ? 0.25 : behind && place.length() > centre.length() ? 0.15 : 0.92;
    });
  }

  /** In the renderer's sense: x to the right, y up, looking along -z. */
  orientation(i) {
    const [x, y, z] = this.views[i].rotation.map(row => new this.THREE.Vector3(...row));
    const matrix = new this.THREE.Matrix4().makeBasis(x, y.negate(), z.negate());
    return new this.THREE.Quaternion().setFromRotationMatrix(matrix);
  }

  /** Where the photograph lies, whole, on an element of that size, in pixels of the element. */
  rectangle(i, width, height) {
    const [w, h] = this.views[i].size, scale = Math.min(width / w, height / h);
    return { scale, left: (width - scale * w) / 2, top: (height - scale * h) / 2, width: scale * w, height: scale * h };
  }

  /** The camera's projection, for an element on which its photograph lies in its rectangle. */
  projection(i, width, height, near, far) {
    const { focal, skew, principal } = this.views[i];
    const { scale, left, top } = this.rectangle(i, width, height);
    const across = 2 * scale / width, down = 2 * scale / height;
    // Columns belong to x, -y and -z of the camera's frame, whose y points down and z ahead.
    return new this.THREE.Matrix4().set(
      across * focal[0], -across * skew, -(across * (principal[0] + 0.5) + 2 * left / width - 1), 0,
      0, down * focal[1], -(1 - down * (principal[1] + 0.5) - 2 * top / height), 0,
      0, 0, -(far + near) / (far - near), -2 * far * near / (far - near),
      0, 0, -1, 0);
  }
}
