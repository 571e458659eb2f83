// The gears as solid bodies, in mesh; a scene comes as GLB from the address that is told. Nothing is drawn while nothing moves.
import { GLTFLoader, OrbitControls, THREE } from "nicegui-scene";

export default {
  template: `<div class="scene" tabindex="0" role="img" :aria-label="label"><canvas></canvas><p v-if="whyNot">{{ whyNot }}</p></div>`,
  props: { label: String },
  data() {
    return { whyNot: "" };
  },
  mounted() {
    this.axles = [];
    this.turn = 0;
    this.wanted = 0;
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.1, 1e5);
    this.camera.up.set(0, 0, 1);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x667788, 2.2));
    const light = new THREE.DirectionalLight(0xffffff, 2.0);
    this.camera.add(light);
    this.scene.add(this.camera);
    try {
      this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, canvas: this.$el.children[0] });
    } catch {
      this.whyNot = "WebGL";
      return;
    }
    this.renderer.localClippingEnabled = true;
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", this.draw);
    this.observer = new ResizeObserver(this.resize);
    this.observer.observe(this.$el);
    this.resize();
  },
  beforeUnmount() {
    this.observer?.disconnect();
    this.renderer?.dispose();
  },
  methods: {
    // Show what is at an address; what was asked for before and comes later is not shown.
    async show(url, axles, whyNot) {
      const number = ++this.wanted;
      this.whyNot = whyNot;
      if (!url) {
        if (this.gears) this.drop(this.gears);
        this.gears = undefined;
        this.draw();
        return;
      }
      const answer = await fetch(url);
      if (!answer.ok || !this.renderer) return;
      const content = await answer.arrayBuffer();
      const { scene } = await new GLTFLoader().parseAsync(content, "");
      if (number !== this.wanted) return;
      const first = !this.gears;
      if (this.gears) this.drop(this.gears);
      scene.rotation.x = Math.PI / 2; // back from the glTF's y up to z up, and to mm
      scene.scale.setScalar(1000);
      this.gears = scene;
      this.axles = axles.map(({ name, ratio }) => ({ node: scene.getObjectByName(name), ratio })).filter(({ node }) => node);
      for (const axle of this.axles) axle.start = axle.node.quaternion.clone();
      this.scene.add(scene);
      if (first) this.fit();
      this.pose(this.turn);
      this.$el.dataset.shown = url;
    },
    drop(object) {
      this.scene.remove(object);
      object.traverse((part) => {
        part.geometry?.dispose();
        part.material?.dispose();
      });
    },
    // Look at all of it from the front, a little from above.
    fit() {
      const box = new THREE.Box3().setFromObject(this.gears);
      const centre = box.getCenter(new THREE.Vector3());
      const reach = box.getSize(new THREE.Vector3()).length() / 2;
      const away = reach / Math.sin((this.camera.fov * Math.PI) / 360);
      this.camera.position.copy(centre).add(new THREE.Vector3(0.35, -0.55, 0.75).normalize().multiplyScalar(away));
      this.camera.near = away / 100;
      this.camera.far = away * 10;
      this.camera.updateProjectionMatrix();
      this.controls.target.copy(centre);
      this.controls.update();
      this.draw();
    },
    // Turn the first axle by so many radians, the others by their ratios.
    pose(turn) {
      this.turn = turn;
      const axis = new THREE.Vector3(0, 0, 1);
      for (const { node, start, ratio } of this.axles)
        node.quaternion.copy(start).multiply(new THREE.Quaternion().setFromAxisAngle(axis, turn * ratio));
      this.draw();
    },
    resize() {
      const { clientWidth: width, clientHeight: height } = this.$el;
      if (!width || !height) return;
      this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.draw();
    },
    draw() {
      if (this.drawing || !this.renderer) return;
      this.drawing = requestAnimationFrame(() => {
        this.drawing = 0;
        this.renderer.render(this.scene, this.camera);
      });
    },
  },
};
