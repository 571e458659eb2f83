// The transverse section of the mesh, turned by the roll angle: outlines, circles, path of contact. Lengths are in mm, y is up.
export default {
  template: `
    <svg class="section" :viewBox="box" preserveAspectRatio="xMidYMid meet" role="img" :aria-label="label">
      <g transform="scale(1,-1)" v-if="content">
        <g v-for="gear in content.gears" :key="gear.name" :class="gear.name" :transform="'translate(' + gear.x + ')'">
          <path class="teeth" fill-rule="evenodd" :d="outline(gear)" :transform="turned(gear)" />
          <circle v-for="(diameter, kind) in gear.circles" :key="kind" :class="kind" :r="diameter / 2"><title>{{ kind }}</title></circle>
          <circle v-if="gear.pitch" class="pitch" :r="gear.pitch / 2" />
        </g>
        <g v-for="gear in kept?.gears ?? []" :key="'kept ' + gear.name" class="kept" :transform="'translate(' + gear.x + ')'">
          <path :d="outline(gear)" :transform="turned(gear)" />
        </g>
        <g v-if="content.line" class="line" :transform="line">
          <line class="action" x1="0" :x2="content.line.length" />
          <line class="path" :x1="content.line.path[0]" :x2="content.line.path[4]" />
        </g>
      </g>
    </svg>`,
  props: { label: String },
  data() {
    return { content: null, kept: null, turn: 0, near: true };
  },
  computed: {
    box() {
      if (!this.content) return "-1 -1 2 2";
      const gears = this.content.gears;
      if (gears.length > 1 && this.near) {
        const { base, angle, path, length } = this.content.line;
        const pitch = base / Math.cos(angle);
        const reach = Math.max(path[4] - path[0], length * 0.2) * 1.3;
        return `${pitch - reach} ${-reach} ${2 * reach} ${2 * reach}`;
      }
      const half = (gear) => (gear.rim ?? gear.circles.tip) / 2;
      const left = Math.min(...gears.map((gear) => gear.x - half(gear)));
      const right = Math.max(...gears.map((gear) => gear.x + half(gear)));
      const height = Math.max(...gears.map(half));
      return `${left} ${-height} ${right - left} ${2 * height}`;
    },
    // Along the line of action from T1, where it touches the first base circle.
    line() {
      const { base, angle } = this.content.line;
      const degrees = 90 - (angle * 180) / Math.PI;
      return `translate(${base * Math.cos(angle)} ${-base * Math.sin(angle)}) rotate(${degrees})`;
    },
  },
  methods: {
    show(content) {
      this.content = content;
    },
    keep(content) {
      this.kept = content;
    },
    pose(turn) {
      this.turn = turn;
    },
    turned(gear) {
      return `rotate(${((gear.turn + this.turn * gear.ratio) * 180) / Math.PI})`;
    },
    outline(gear) {
      const points = [];
      for (let at = 0; at < gear.outline.length; at += 2) points.push(`${gear.outline[at]} ${gear.outline[at + 1]}`);
      const circle = (diameter) => `M${diameter / 2} 0a${diameter / 2} ${diameter / 2} 0 1 0 ${-diameter} 0a${diameter / 2} ${diameter / 2} 0 1 0 ${diameter} 0Z`;
      const hole = gear.teeth > 0 ? gear.bore : gear.rim;
      return `M${points.join("L")}Z${hole ? circle(hole) : ""}`;
    },
  },
};
