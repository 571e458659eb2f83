// The gears as solid bodies, in mesh. Surfaces come by their keys: what stays the same is not sent again. Lengths in mm, z up.
import { colouredTeeth } from "gear-colours";
import { shown, shownNumber, shownUnit } from "gear-units";
import { cutOf, surfaceOf } from "gear-surfaces";
import { OrbitControls, THREE } from "nicegui-scene";

const AXES = { x: [-1, 0, 0], y: [0, 1, 0], z: [0, 0, -1] }; // where a cut looks: what is beyond it is taken away
const VIEWS = { front: [0, 0, 1, 0, 1, 0], top: [0, 1, 0.001, 0, 0, -1], iso: [0.5, -0.75, 0.6, 0, 0, 1] };
const SENT = "gear_bodies"; // the message that has bodies
const COLOURED = "gear_colours"; // the message that has stresses of their teeth
const LONG = 0.9; // length over the diagonal of the box of a shaft
const CLICK = 4; // pixels that a pointer may move, and still click
const REST = 400; // ms after which what is drawn without a graphics card is drawn once more, smoothly

// Whether the processor draws: edges that are smooth in every frame are most of its work.
function isWithoutCard() {
  const context = document.createElement("canvas").getContext("webgl2");
  const told = context?.getExtension("WEBGL_debug_renderer_info");
  const name = told ? context.getParameter(told.UNMASKED_RENDERER_WEBGL) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}


export default {
  template: `
    <div class="scene">
      <canvas ref="canvas" tabindex="0" role="img" :aria-label="label" @pointerdown="press" @pointerup="pick" @keydown="key"></canvas>
      <div class="tools" v-if="!whyNot">
        <button v-for="(_, name) in views" type="button" @click="look(name)">{{ words[name] }}</button>
        <button type="button" @click="fit()">{{ words.fit }}</button>
        <button type="button" :aria-pressed="edges" @click="edges = !edges">{{ words.edges }}</button>
        <select v-model="axis" :title="words.cut" :aria-label="words.cut"><option value="">{{ words.whole }}</option><option v-for="each in ['x', 'y', 'z']" :value="each">{{ words.cut }} {{ each }}</option></select>
        <label v-if="axis"><input type="range" min="0" max="1" step="0.005" v-model.number="share" :aria-label="words.cut" />{{ cutAt }}</label>
        <button type="button" :aria-pressed="measuring" @click="measuring = !measuring">{{ words.measure }}</button>
      </div>
      <p class="told measured" v-if="measuring">{{ measured }}</p>
      <p class="nothing" v-if="whyNot" role="status">{{ whyNot }}</p>
    </div>`,
  props: { label: String, words: Object },
  data() {
    return { whyNot: "", edges: true, axis: "", share: 0.5, cutAt: "", measuring: false, points: [], error: 0, views: VIEWS };
  },
  computed: {
    measured() {
      if (this.points.length < 2) return this.words.click;
      const [from, to] = this.points;
      const [x, y, z] = to.map((each, n) => each - from[n]);
      const [size, off] = [Math.hypot(x, y, z), 2 * this.error];
      return `${shown(size, 3, "mm")}   x ${shownNumber(x, 3, "mm")}   y ${shownNumber(y, 3, "mm")}   z ${shownNumber(z, 3, "mm")}   (±${(off / shownUnit("mm").size).toLocaleString(document.documentElement.lang || "en", { maximumSignificantDigits: 2 })}: ${this.words.facets})`;
    },
  },
  watch: {
    edges: "restyle",
    axis: "cut",
    share: "moveCut",
    measuring() {
      this.mark([]);
    },
  },
  mounted() {
    [this.turn, this.gears, this.surfaces, this.looks] = [0, [], new Map(), []];
    [this.coloured, this.colours, this.kind] = [[], null, "pressure"];
    this.$nextTick(() => (window.socket.on(SENT, this.show), window.socket.on(COLOURED, this.take))); // once the page is mounted
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(30, 1, 0.1, 1e5);
    this.camera.up.set(0, 0, 1);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8899aa, 1.6));
    const light = new THREE.DirectionalLight(0xffffff, 2.2);
    light.position.set(-0.6, 0.8, 1);
    this.camera.add(light);
    this.scene.add(this.camera);
    const canvas = this.$refs.canvas;
    try {
      this.slow = isWithoutCard();
      this.renderer = new THREE.WebGLRenderer({ antialias: !this.slow, alpha: true, stencil: true, canvas });
    } catch {
      this.whyNot = this.words.noWebGL;
      this.$el.dataset.shown = "0";
      return;
    }
    this.renderer.localClippingEnabled = true;
    canvas.addEventListener("webglcontextlost", (event) => (event.preventDefault(), (this.whyNot = this.words.lost)));
    canvas.addEventListener("webglcontextrestored", () => ((this.whyNot = ""), this.draw()));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", this.draw);
    this.plane = new THREE.Plane();
    this.marks = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ depthTest: false }));
    this.marks.frustumCulled = false;
    this.dots = new THREE.Points(this.marks.geometry, new THREE.PointsMaterial({ size: 7, sizeAttenuation: false, depthTest: false }));
    this.dots.frustumCulled = false;
    this.marks.renderOrder = this.dots.renderOrder = 1e3;
    this.marks.visible = this.dots.visible = false;
    this.scene.add(this.marks, this.dots);
    this.observers = [new ResizeObserver(this.resize), new MutationObserver(this.restyle)];
    this.observers[0].observe(this.$el);
    this.observers[1].observe(document.body, { attributeFilter: ["class"] });
    window.addEventListener("gear-turn", this.roll);
    window.addEventListener("gear-coloured", this.choose);
    this.resize();
    this.restyle();
  },
  beforeUnmount() {
    window.socket?.off(SENT, this.show);
    window.socket?.off(COLOURED, this.take);
    window.removeEventListener("gear-coloured", this.choose);
    for (const observer of this.observers ?? []) observer.disconnect();
    window.removeEventListener("gear-turn", this.roll);
    cancelAnimationFrame(this.drawing);
    clearTimeout(this.resting);
    this.drop();
    for (const each of this.looks?.flat() ?? []) each.dispose();
    this.controls?.dispose();
    this.renderer?.dispose();
  },
  methods: {
    // Show bodies, whose surfaces are kept by their keys as long as they are seen.
    show({ number, bodies, surfaces, error, whyNot }) {
      if (!this.renderer) return (this.$el.dataset.shown = number);
      this.whyNot = whyNot;
      for (const [key, content] of Object.entries(surfaces)) this.surfaces.set(key, surfaceOf(THREE, content));
      this.drop(new Set(bodies.map((body) => body.surface)));
      this.gears = bodies.map(this.made);
      this.error = error;
      this.mark([]);
      this.colour();
      this.pose();
      const size = this.box().getSize(new THREE.Vector3()).length();
      if (size && Math.abs(Math.log(size / (this.size ?? 1e-9))) > 0.25) this.look("iso");
      this.size = size || this.size;
      this.cut();
      this.$el.dataset.shown = number;
    },
    // A body as it is seen. Materials stay for the next that stands in its place: with the last of them a browser would forget how it draws.
    made(body, place) {
      const { surface, edges } = this.surfaces.get(body.surface);
      const colour = new THREE.Color().setRGB(...body.colour, THREE.SRGBColorSpace);
      const looks = { metalness: 0.25, roughness: 0.55, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
      const [skin, ink] = (this.looks[place] ??= [new THREE.MeshStandardMaterial(looks), new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55 })]);
      skin.color.copy(colour);
      const group = new THREE.Group();
      const mesh = new THREE.Mesh(surface, skin);
      const lines = new THREE.LineSegments(edges, ink);
      group.add(mesh, lines);
      this.scene.add(group);
      return { body, group, mesh, lines, colour };
    },
    // Let go of the bodies, and of all surfaces but those of these keys.
    drop(keys = new Set()) {
      this.uncut();
      this.uncolour();
      for (const { group } of this.gears) this.scene.remove(group);
      this.gears = [];
      for (const [key, { surface, edges }] of this.surfaces)
        if (!keys.has(key)) {
          surface.dispose();
          edges.dispose();
          this.surfaces.delete(key);
        }
    },
    // ---------------------------------------------------------------- stresses
    // Coloured teeth of some bodies, by kinds of stress; null if there are none of these gears.
    take(colours) {
      this.colours = colours.kinds?.length ? colours : null;
      this.colour();
      this.cut();
    },
    choose({ detail: { kind } }) {
      this.kind = kind;
      this.colour();
      this.cut();
    },
    colour() {
      this.uncolour();
      const kinds = this.colours?.kinds ?? [];
      const chosen = kinds.find(({ key }) => key === this.kind);
      for (const { body, role, teeth } of chosen?.on ?? []) {
        if (!this.gears[body]) continue;
        const mesh = colouredTeeth(THREE, chosen.surfaces[role], chosen.most, teeth);
        mesh.renderOrder = this.gears.length + 3;
        this.gears[body].group.add(mesh);
        this.coloured.push(mesh);
      }
      const bars = kinds.length ? [{ words: chosen?.words ?? "", most: chosen?.told ?? "" }] : null;
      const told = kinds.map(({ key, words }) => ({ key, words }));
      window.dispatchEvent(new CustomEvent("gear-legend", { detail: { place: "bodies", bars, kinds: told, kind: chosen ? this.kind : "" } }));
      this.$el.dataset.coloured = this.coloured.length;
    },
    uncolour() {
      for (const mesh of this.coloured ?? []) {
        mesh.removeFromParent();
        mesh.geometry.dispose();
        mesh.material.dispose();
        mesh.dispose();
      }
      this.coloured = [];
    },
    // ---------------------------------------------------------------- turning
    roll(event) {
      this.turn = event.detail.turn;
      if (this.points.length) this.mark([]);
      this.pose();
    },
    pose() {
      for (const { body, group } of this.gears) {
        const [x, y, z] = body.place;
        const [round, slide] = [body.orbit * this.turn, body.slide * this.turn];
        group.position.set(x * Math.cos(round) - y * Math.sin(round), x * Math.sin(round) + y * Math.cos(round) + slide, z);
        group.rotation.z = body.rotation + (body.ratio + body.orbit) * this.turn;
      }
      this.draw();
    },
    // ---------------------------------------------------------------- cuts
    cut() {
      this.uncut();
      if (this.axis) {
        this.plane.normal.set(...AXES[this.axis]);
        this.gears.forEach((gear, n) => {
          gear.cut = cutOf(THREE, gear.mesh.geometry, gear.colour, this.plane, n + 1);
          gear.group.add(...gear.cut.counted);
          this.scene.add(gear.cut.cap);
          gear.mesh.renderOrder = gear.lines.renderOrder = this.gears.length + 2;
        });
      }
      const planes = this.axis ? [this.plane] : null;
      for (const { mesh, lines } of this.gears)
        for (const { material } of [mesh, lines]) {
          material.needsUpdate = !material.clippingPlanes !== !planes;
          material.clippingPlanes = planes;
        }
      for (const { material } of this.coloured) [material.clippingPlanes, material.needsUpdate] = [planes, true];
      this.moveCut();
    },
    uncut() {
      for (const gear of this.gears) {
        if (!gear.cut) continue;
        gear.group.remove(...gear.cut.counted);
        this.scene.remove(gear.cut.cap);
        for (const each of [...gear.cut.counted, gear.cut.cap]) each.material.dispose();
        gear.cut.cap.geometry.dispose();
        gear.cut = undefined;
      }
    },
    moveCut() {
      const box = this.box();
      if (this.axis && !box.isEmpty()) {
        const place = box.min[this.axis] + this.share * (box.max[this.axis] - box.min[this.axis]);
        const normal = this.plane.normal;
        this.plane.constant = -normal[this.axis] * place;
        const [middle, size] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3()).length()];
        middle[this.axis] = place;
        for (const { cut } of this.gears) {
          cut.cap.position.copy(middle);
          cut.cap.lookAt(middle.clone().sub(normal));
          cut.cap.scale.setScalar(2 * size);
        }
        this.cutAt = shown(place, 2, "mm");
      }
      this.restyle();
      this.pose();
    },
    // ---------------------------------------------------------------- looking
    box() {
      const box = new THREE.Box3();
      for (const { group, mesh } of this.gears) {
        group.updateMatrixWorld();
        box.expandByObject(mesh);
      }
      return box;
    },
    look(name) {
      const [x, y, z, ...up] = VIEWS[name];
      this.camera.up.set(...(name === "front" ? [0, 1, 0] : [0, 0, 1]));
      if (name === "top") this.camera.up.set(0, 0, 1);
      this.controls.dispose();
      this.controls = new OrbitControls(this.camera, this.$refs.canvas);
      this.controls.addEventListener("change", this.draw);
      this.fit(new THREE.Vector3(x, y, z));
    },
    fit(from) {
      const box = this.box();
      if (box.isEmpty()) return;
      const [centre, size] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3())];
      const reach = size.length() / 2;
      const share = Math.max(...size.toArray()) > LONG * 2 * reach ? 1.05 : 0.82; // what is long reaches the corners of its box
      const direction = from ?? this.camera.position.clone().sub(this.controls.target);
      const narrow = Math.min(1, this.camera.aspect);
      const away = (share * reach) / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
      this.camera.position.copy(centre).add(direction.normalize().multiplyScalar(away));
      Object.assign(this.camera, { near: away / 200, far: away * 20 });
      this.camera.updateProjectionMatrix();
      this.controls.target.copy(centre);
      this.controls.update();
      this.draw();
    },
    key(event) {
      const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
      const away = this.camera.position.clone().sub(this.controls.target);
      const upright = new THREE.Quaternion().setFromUnitVectors(this.camera.up, new THREE.Vector3(0, 1, 0));
      const ball = new THREE.Spherical().setFromVector3(away.applyQuaternion(upright));
      if (event.key in turns) [ball.theta, ball.phi] = [ball.theta + 0.12 * turns[event.key][0], ball.phi + 0.12 * turns[event.key][1]];
      else if ("+-".includes(event.key)) ball.radius *= event.key === "+" ? 0.85 : 1 / 0.85;
      else return;
      event.preventDefault();
      ball.makeSafe();
      this.camera.position.setFromSpherical(ball).applyQuaternion(upright.invert()).add(this.controls.target);
      this.controls.update();
      this.draw();
    },
    // ---------------------------------------------------------------- measuring
    press(event) {
      this.pressed = [event.offsetX, event.offsetY];
    },
    pick(event) {
      const [x, y] = [event.offsetX, event.offsetY];
      if (!this.measuring || !this.pressed || Math.hypot(x - this.pressed[0], y - this.pressed[1]) > CLICK) return;
      const { clientWidth: width, clientHeight: height } = this.$refs.canvas;
      this.scene.updateMatrixWorld(); // the last change of the view may not be drawn yet
      const ray = new THREE.Raycaster();
      ray.setFromCamera(new THREE.Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.camera);
      const hits = ray.intersectObjects(this.gears.map(({ mesh }) => mesh), false);
      const hit = hits.find(({ point }) => !this.axis || this.plane.distanceToPoint(point) >= 0);
      if (hit) this.mark([...this.points.slice(this.points.length > 1 ? 2 : 0), hit.point.toArray()]);
    },
    mark(points) {
      this.points = points;
      if (!this.marks) return;
      const vectors = points.map((point) => new THREE.Vector3(...point));
      if (points.length) this.marks.geometry.setFromPoints(points.length > 1 ? vectors : [vectors[0], vectors[0]]);
      this.marks.visible = this.dots.visible = points.length > 0;
      this.draw();
    },
    // ---------------------------------------------------------------- drawing
    restyle() {
      if (!this.renderer) return;
      const style = getComputedStyle(document.body);
      const ink = document.body.classList.contains("body--dark") ? "#05080b" : style.getPropertyValue("--ink").trim();
      for (const { lines } of this.gears) {
        lines.visible = this.edges;
        lines.material.color.set(ink);
      }
      for (const each of [this.marks, this.dots]) each.material.color.set(style.getPropertyValue("--wrong").trim());
      this.draw();
    },
    resize() {
      const { clientWidth: width, clientHeight: height } = this.$el;
      if (!width || !height) return;
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.draw();
    },
    draw() {
      if (this.drawing || !this.renderer) return;
      clearTimeout(this.resting);
      this.drawing = requestAnimationFrame(() => {
        this.drawing = 0;
        this.render(1);
        if (this.slow) this.resting = setTimeout(this.render, REST, 2);
      });
    },
    // With so many pixels in the place of one, in both directions.
    render(finer) {
      if (this.renderer.getContext().isContextLost()) return;
      const ratio = finer * Math.min(window.devicePixelRatio, 2);
      if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
      this.renderer.render(this.scene, this.camera);
      const { geometries, textures } = this.renderer.info.memory;
      Object.assign(this.$el.dataset, { geometries, textures, programs: this.renderer.info.programs.length });
    },
  },
};
