// The machine in three dimensions: draws the scene that Python describes (takt/scene), with three.js.
//
// What moves is placed by poses and signals that are published; there are no kinematics here.

import { byId, css, el, tone } from "./dom.js";
import { Orbit } from "./orbit.js";

const TRAIL_S = 3;
const TRAIL_POINTS = 1500;
const LABEL = 12; // pixels
const LEAST = 22; // pixels that something has to be large to have a label
const COLOURS = {
  base: "--link", link: "--accent", joint: "--ink", rod: "--soft", tool: "--soft", tip: "--bad", belt: "--zero", mark: "--soft", limit: "--accent",
  stator: "--stator", mover: "--accent", obstacle: "--warn", zone: "--warn", bound: "--accent", bad: "--bad", product: "--warn", near: "--good", taken: "--soft",
  axis_x: "--bad", axis_y: "--good", axis_z: "--accent",
};
const CLEAR = { zone: 0.16, bound: 0.06, obstacle: 0.6 }; // how opaque
const COLLISION = 1; // values of a group's `trouble`
const BOUNDS = 2;

// `load` gives three.js; `series` says the columns that trails of tools are made of, by component; `ctrlZooms`: the
// wheel alone scrolls the page; `onchange` is called when what is to be seen was moved.
export class Space {
  constructor(model, series, load, { ctrlZooms = false, onchange = () => {} } = {}) {
    Object.assign(this, { model, series, load, ctrlZooms, onchange });
    this.canvas = byId("space-canvas");
    this.box = byId("space-box");
    this.nodes = [];
    this.frames = 0; // that were drawn
    this.follow = "";
    this.controls();
  }

  begin() {
    this.scene = this.model.machine.scene;
    byId("space-empty").hidden = this.scene.nodes.length > 0;
    byId("space-empty").textContent = "This machine has nothing to be seen in three dimensions.";
    const followed = this.scene.followed ?? [];
    const select = byId("space-follow");
    select.replaceChildren(el("option", { value: "", textContent: "nothing" }), ...followed.map((name) => el("option", { value: name, textContent: name })));
    select.parentElement.hidden = !followed.length;
    this.follow = "";
    this.made = this.bounds = null;
    this.fitted = false;
  }

  // Signals that the trails of tools are made of.
  signals() {
    return (this.scene?.trails ?? []).flatMap(({ group }) => ["x", "y", "z"].map((field) => [this.model.byName.get(group).index, field]));
  }

  // --- what there is ---

  async open() {
    if (this.three || this.opening) return;
    this.opening = true;
    try {
      const three = await this.load();
      this.renderer = new three.WebGLRenderer({ canvas: this.canvas, antialias: true });
      this.renderer.outputColorSpace = three.LinearSRGBColorSpace; // colours of the page as they are
      three.ColorManagement.enabled = false;
      this.three = three;
      this.orbit = new Orbit(three);
      this.draw();
      this.onchange();
    } catch (error) {
      byId("space-empty").hidden = false;
      byId("space-empty").textContent = `This browser cannot draw in three dimensions: ${error.message}`;
    }
  }

  make() {
    const { three, scene } = this;
    this.made = scene;
    this.world = new three.Scene();
    this.things = new three.Group(); // that the camera is fitted to
    this.geometries = new Map();
    this.materials = new Map();
    this.products = new Map();
    this.lines = new Map(); // of tracks
    this.labels = [];
    this.world.add(this.things, new three.HemisphereLight(0xffffff, 0x8a8f98, 2.1));
    const sun = new three.DirectionalLight(0xffffff, 1.5);
    sun.position.set(-0.5, -1, 1.6);
    this.world.add(sun);
    this.nodes = scene.nodes.map((node) => this.node(node));
    this.byName = new Map(this.nodes.map((one) => [one.node.name, one]));
    this.trails = (scene.trails ?? []).map(({ group, base }) => {
      const line = new three.Line(new three.BufferGeometry(), new three.LineBasicMaterial());
      line.geometry.setAttribute("position", new three.BufferAttribute(new Float32Array(3 * TRAIL_POINTS), 3));
      line.frustumCulled = false;
      this.world.add(line);
      return { line, base, component: this.model.byName.get(group) };
    });
  }

  node(node) {
    const { three } = this;
    const root = new three.Group();
    root.matrixAutoUpdate = false;
    const meshes = node.solids.map((solid) => this.solid(solid, root));
    const rest = new three.Matrix4();
    if (node.at) rest.set(...node.at, 0, 0, 0, 1);
    if (node.label) this.label(node, root);
    this.things.add(root);
    const component = node.moved?.component && this.model.byName.get(node.moved.component);
    return { node, root, rest, meshes, component };
  }

  solid(solid, root) {
    const { three } = this;
    const material = this.material(solid.colour);
    if (solid.kind === "tiles") {
      const [x, y, z] = solid.size;
      const tiles = new three.InstancedMesh(this.geometry("box", [x - 3, y - 3, z]), material, solid.places.length);
      solid.places.forEach(([px, py], i) => tiles.setMatrixAt(i, new three.Matrix4().makeTranslation(px + x / 2, py + y / 2, -z / 2 - 1)));
      root.add(tiles);
      return tiles;
    }
    const mesh = new three.Mesh(solid.kind === "mesh" ? this.surface(solid) : this.geometry(solid.kind, solid.size), material);
    mesh.matrixAutoUpdate = false;
    if (solid.at) mesh.matrix.set(...solid.at, 0, 0, 0, 1);
    mesh.userData = { part: solid.part, colour: solid.colour };
    root.add(mesh);
    if (solid.colour in CLEAR && solid.kind === "box") {
      const edges = new three.LineSegments(new three.EdgesGeometry(mesh.geometry), this.material(solid.colour, true));
      edges.matrixAutoUpdate = false;
      edges.matrix.copy(mesh.matrix);
      root.add(edges);
    }
    return mesh;
  }

  // Along Z, with the middle in the origin, as the scene has them.
  geometry(kind, size) {
    const { three } = this;
    const key = `${kind} ${size}`;
    if (!this.geometries.has(key)) {
      const [a, b, c] = size;
      const made = {
        box: () => new three.BoxGeometry(a, b, c),
        cylinder: () => new three.CylinderGeometry(a, a, b, 28).rotateX(Math.PI / 2),
        capsule: () => new three.CapsuleGeometry(a, b, 6, 18).rotateX(Math.PI / 2),
        sphere: () => new three.SphereGeometry(a, 20, 14),
      }[kind]();
      this.geometries.set(key, made);
    }
    return this.geometries.get(key);
  }

  surface({ vertices, triangles }) {
    const { three } = this;
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.Float32BufferAttribute(vertices, 3));
    geometry.setIndex(triangles);
    const facets = geometry.toNonIndexed(); // edges of machines are sharp
    facets.computeVertexNormals();
    return facets;
  }

  material(colour, lines = false) {
    const { three } = this;
    const key = `${colour} ${lines}`;
    if (!this.materials.has(key)) {
      const opacity = CLEAR[colour];
      const clear = opacity === undefined ? {} : { transparent: true, opacity, depthWrite: false, side: three.DoubleSide };
      const material = lines ? new three.LineBasicMaterial({ transparent: true, opacity: 0.7 }) : new three.MeshLambertMaterial(clear);
      if (colour in CLEAR || colour === "stator") material.polygonOffset = !lines;
      this.materials.set(key, material);
      material.color.set(this.colour(colour));
    }
    return this.materials.get(key);
  }

  // The name of a role, or a colour as it is.
  colour(role) {
    return COLOURS[role] ? css(COLOURS[role]) : tone(role);
  }

  label({ name, of, solids, label }, parent) {
    const { three } = this;
    const sprite = new three.Sprite(new three.SpriteMaterial({ sizeAttenuation: false, depthTest: false, premultipliedAlpha: true }));
    const size = Math.max(...solids[0].size);
    sprite.userData = { text: of ?? name, size };
    sprite.position.set(0, 0, label);
    sprite.center.set(0, 0);
    sprite.renderOrder = 2;
    parent.add(sprite);
    this.labels.push(sprite);
    return sprite;
  }

  write(sprite) {
    const { three } = this;
    const canvas = document.createElement("canvas");
    const c = canvas.getContext("2d");
    const font = `${2 * LABEL}px ${css("--font")}`;
    c.font = font;
    canvas.width = Math.ceil(c.measureText(sprite.userData.text).width) + 12;
    canvas.height = 3 * LABEL;
    c.font = font;
    c.textBaseline = "middle";
    c.lineWidth = 6;
    c.lineJoin = "round";
    c.strokeStyle = css("--card");
    c.strokeText(sprite.userData.text, 6, 1.55 * LABEL);
    c.fillStyle = css("--ink");
    c.fillText(sprite.userData.text, 6, 1.55 * LABEL);
    sprite.material.map?.dispose();
    sprite.material.map = Object.assign(new three.CanvasTexture(canvas), { premultiplyAlpha: true, generateMipmaps: false, minFilter: three.LinearFilter });
    sprite.material.needsUpdate = true;
    const high = (1.5 * LABEL * this.orbit.perPixel) / this.orbit.distance; // the size on the screen stays
    sprite.scale.set((high * canvas.width) / canvas.height, high, 1);
  }

  // --- how it is now ---

  place() {
    for (const one of this.nodes) {
      const known = this.placed(one);
      one.root.visible = known && this.shown(one);
      if (!known) continue;
      one.root.matrixWorldNeedsUpdate = true;
      if (this.floor && one.node.moved?.group) this.floor.position.z = Math.min(this.floor.position.z, one.root.matrix.elements[14] - 10);
    }
  }

  shown({ node: { shown } }) {
    return !shown || this.model.liveOf(this.model.byName.get(shown.component), shown.field) > 0;
  }

  placed({ node, root, rest, component }) {
    const { three, model } = this;
    const { moved } = node;
    if (!moved) root.matrix.copy(rest);
    else if ("link" in moved) {
      const pose = model.poses[moved.group]?.[moved.link];
      if (!pose) return false;
      const [x, y, z, ...turn] = pose;
      root.matrix.compose(new three.Vector3(x, y, z), new three.Quaternion(...turn).normalize(), new three.Vector3(1, 1, 1)).multiply(rest);
    } else if ("slide" in moved) {
      const position = model.liveOf(component, moved.slide);
      if (!Number.isFinite(position)) return false;
      let way = (position - (moved.from ?? 0)) * (moved.scale ?? 1);
      if (moved.wrap) way -= moved.wrap * Math.floor(way / moved.wrap);
      const step = moved.turns ? new three.Matrix4().makeRotationZ((way * Math.PI) / 180) : new three.Matrix4().makeTranslation(way, 0, 0);
      root.matrix.copy(rest).multiply(step);
    } else {
      const [x, y, z, a, b, c] = moved.pose.map((field) => (field ? model.liveOf(component, field) : 0));
      if (![x, y, z, a, b, c].every(Number.isFinite)) return false;
      const [rx, ry, rz] = [a, b, c].map((angle) => (angle * Math.PI) / 180);
      root.matrix.makeRotationFromEuler(new three.Euler(rx, ry, rz, "ZYX")).setPosition(x, y, z).multiply(rest);
      if (moved.system) root.matrix.elements[14] += this.scene.heights[model.liveOf(component, moved.system) - 1] ?? 0;
    }
    return true;
  }

  // Movers have the colour of their state; what a path was refused for is red.
  paint() {
    const { model } = this;
    const refused = new Map();
    const said = [];
    for (const [group, parts] of Object.entries(this.scene.parts ?? {})) {
      const of = (field) => model.liveOf(model.byName.get(group), field);
      const trouble = of("trouble");
      if (trouble !== COLLISION && trouble !== BOUNDS) continue;
      const names = [of("first_part"), of("second_part")].map((number) => parts[number - 1]).filter(Boolean);
      refused.set(group, new Set(names));
      said.push(`${group}: ${names.join(trouble === COLLISION ? " would meet " : " would leave ")}, ${of("blocked_at").toFixed(1)} mm along the path that was refused`);
    }
    byId("space-refused").hidden = !said.length;
    byId("space-refused").textContent = said.join("; ");
    for (const { node, meshes, component } of this.nodes) {
      const state = component?.kind === "mover" ? model.machine.states[model.rows[component.index]?.state] : null;
      const parts = refused.get(node.of);
      for (const mesh of meshes) {
        const { colour, part } = mesh.userData;
        if (!colour) continue;
        const own = colour === "mover" && state ? state : colour;
        mesh.material = this.material(part && parts?.has(part) ? "bad" : own);
      }
    }
  }

  // What lies on belts; the tool touches its top.
  lay() {
    const { three, model } = this;
    for (const [belt, { size }] of Object.entries(this.scene.belts ?? {})) {
      if (!this.products.has(belt)) this.products.set(belt, []);
      const pool = this.products.get(belt);
      const objects = model.objects[belt] ?? [];
      while (pool.length < objects.length) {
        const mesh = new three.Mesh(this.geometry("box", size), this.material("product"));
        this.world.add(mesh);
        pool.push(mesh);
      }
      pool.forEach((mesh, i) => {
        const object = objects[i];
        mesh.visible = Boolean(object);
        if (!object) return;
        const [, x, y, z, turn, taken, inRange] = object;
        mesh.position.set(x, y, z - size[2] / 2);
        mesh.rotation.z = (turn * Math.PI) / 180;
        mesh.material = this.material(taken ? "taken" : inRange ? "near" : "product");
      });
    }
  }

  // Tracks as commands have made them, with their parts.
  drawTracks() {
    const { three, model } = this;
    const names = (model.numbers.track ?? []).map(({ name }) => name);
    for (const [name, track] of model.shapes) {
      const known = this.lines.get(name);
      if (known?.track === track) continue;
      known?.line.removeFromParent();
      const points = [];
      for (let i = 0; i < track.points.length; i += 3) points.push(new three.Vector3(track.points[i + 1], track.points[i + 2], 3));
      if (track.closed && points.length) points.push(points[0]);
      const { palette } = model.machine;
      const colour = palette[Math.max(0, names.indexOf(name)) % palette.length];
      const line = new three.Line(new three.BufferGeometry().setFromPoints(points), this.material(colour, true));
      (this.byName.get(track.part)?.root ?? this.things).add(line);
      this.lines.set(name, { track, line });
    }
  }

  drawTrails() {
    const { model } = this;
    const since = model.cycle - TRAIL_S / model.period;
    for (const { line, base, component } of this.trails) {
      const series = this.series().get(component.index);
      const [x, y, z] = ["x", "y", "z"].map((field) => series?.columns.get(field));
      const [first, end] = x && y && z ? [series.find(since), series.find(model.cycle + 1e-6)] : [0, 0];
      const step = Math.max(1, Math.ceil((end - first) / (TRAIL_POINTS - 1)));
      const places = line.geometry.attributes.position;
      let count = 0;
      const put = (i) => {
        if (!Number.isFinite(x[i])) return;
        const [px, py, pz] = [0, 1, 2].map((r) => base[4 * r] * x[i] + base[4 * r + 1] * y[i] + base[4 * r + 2] * z[i] + base[4 * r + 3]);
        places.setXYZ(count++, px, py, pz);
      };
      for (let i = first; i < end - 1; i += step) put(i);
      if (end > first) put(end - 1);
      places.needsUpdate = true;
      line.geometry.setDrawRange(0, count);
      line.visible = count > 1;
      line.material.color.set(css("--bad"));
    }
  }

  // --- drawing ---

  draw() {
    const [width, height] = [this.box.clientWidth, this.box.clientHeight];
    if (!this.scene?.nodes.length || width < 50 || height < 50) return;
    if (!this.three) return void this.open();
    if (this.made !== this.scene) this.make();
    this.theme();
    const ratio = window.devicePixelRatio || 1;
    if (this.width !== width || this.height !== height || this.ratio !== ratio) {
      Object.assign(this, { width, height, ratio });
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height);
      this.orbit.shape(width, height);
      for (const sprite of this.labels) this.write(sprite);
    }
    this.place();
    this.drawTracks();
    this.paint();
    this.lay();
    this.drawTrails();
    this.world.updateMatrixWorld();
    const seen = this.nodes.filter(({ node, root }) => root.visible && !node.shown).length; // not what comes and goes
    if (!this.fitted || (this.fitted !== "by hand" && seen > this.seen)) this.fit(); // one more to be seen
    this.seen = seen;
    const at = this.followedPlace();
    if (at) this.orbit.goTo(at);
    for (const sprite of this.labels) sprite.visible = sprite.userData.size > LEAST * this.orbit.perPixel;
    this.renderer.render(this.world, this.orbit.camera);
    ++this.frames;
  }

  // All colours anew when the page has become dark or light.
  theme() {
    const theme = `${css("--card")} ${css("--ink")}`;
    if (theme === this.painted && this.paintedOf === this.world) return;
    [this.painted, this.paintedOf] = [theme, this.world];
    this.world.background = new this.three.Color(css("--card"));
    for (const [key, material] of this.materials) material.color.set(this.colour(key.split(" ")[0]));
    for (const sprite of this.labels) this.write(sprite);
    if (this.bounds) this.grid();
  }

  fit() {
    const { three } = this;
    this.bounds = this.nodes.filter(({ root }) => root.visible).map(({ root }) => new three.Box3().setFromObject(root));
    if (!this.bounds.length) return;
    this.fitted ||= "by itself";
    this.orbit.fit(this.bounds);
    this.grid();
  }

  // Under everything, of a round width.
  grid() {
    const { three } = this;
    this.floor?.removeFromParent();
    const bounds = this.bounds.reduce((sum, box) => sum.union(box), new three.Box3());
    const size = bounds.getSize(new three.Vector3());
    const rough = Math.max(size.x, size.y, 100) / 12;
    const cell = [1, 2, 5, 10].map((k) => k * 10 ** Math.floor(Math.log10(rough))).find((width) => width >= rough * 0.999);
    const cells = 2 * Math.ceil(Math.max(size.x, size.y) / cell / 2 + 2);
    const grid = new three.GridHelper(cells * cell, cells, css("--zero"), css("--line")).rotateX(Math.PI / 2);
    const middle = bounds.getCenter(new three.Vector3());
    grid.position.set(Math.round(middle.x / cell) * cell, Math.round(middle.y / cell) * cell, bounds.min.z - 2);
    this.floor = grid;
    this.world.add(grid);
  }

  followedPlace() {
    if (!this.follow) return null;
    const { three } = this;
    const tool = this.byName.get(`${this.follow}.tool`) ?? this.byName.get(this.follow);
    return tool?.root.visible ? new three.Vector3().setFromMatrixPosition(tool.root.matrix) : null;
  }

  // --- what the user does ---

  look(view) {
    if (!this.orbit) return;
    this.orbit.look(view);
    if (this.bounds && !this.follow) this.orbit.fit(this.bounds);
    this.onchange();
  }

  fitAgain() {
    if (!this.orbit) return;
    this.fitted = "by itself";
    this.fit();
    this.onchange();
  }

  moved() {
    this.fitted = "by hand";
    this.onchange();
  }

  // True: the key is for the camera.
  key({ key, shiftKey, ctrlKey, altKey, metaKey }) {
    if (!this.orbit || ctrlKey || altKey || metaKey) return false;
    const views = { t: "top", f: "front", s: "side", p: "corner" };
    const [h, v] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[key] ?? [0, 0];
    const factor = { "+": 0.8, "=": 0.8, "-": 1.25 }[key];
    if (key in views) this.look(views[key]);
    else if (key === "0") this.fitAgain();
    else if (factor) this.orbit.zoom(factor);
    else if (h || v) shiftKey ? this.orbit.pan(-40 * h, 40 * v) : this.orbit.turn(-30 * h, 30 * v);
    else return false;
    if (factor || h || v) this.moved();
    return true;
  }

  controls() {
    const { canvas } = this;
    for (const button of byId("space-views").children) button.onclick = () => this.look(button.value);
    byId("space-fit").onclick = () => this.fitAgain();
    byId("space-follow").onchange = ({ target }) => {
      this.follow = target.value;
      this.onchange();
    };
    canvas.oncontextmenu = (event) => event.preventDefault();
    canvas.onpointerdown = (event) => {
      this.drag = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    };
    canvas.onpointermove = (event) => {
      if (!this.drag || !this.orbit) return;
      const [dx, dy] = [event.clientX - this.drag[0], event.clientY - this.drag[1]];
      this.drag = [event.clientX, event.clientY];
      if (event.buttons & 6 || event.shiftKey) this.orbit.pan(dx, dy);
      else this.orbit.turn(dx, dy);
      this.moved();
    };
    canvas.onpointerup = canvas.onpointercancel = () => (this.drag = null);
    canvas.addEventListener("wheel", (event) => {
      if (!this.orbit || (this.ctrlZooms && !event.ctrlKey && !event.metaKey)) return;
      event.preventDefault();
      this.orbit.zoom(event.deltaY > 0 ? 1.15 : 0.87);
      this.moved();
    }, { passive: false });
    canvas.onkeydown = (event) => {
      if (!this.key(event)) return;
      event.preventDefault();
      event.stopPropagation();
    };
    new ResizeObserver(() => this.onchange()).observe(this.box);
  }
}
