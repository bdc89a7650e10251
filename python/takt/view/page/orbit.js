// A camera that looks at a place from around it. Z is up.

const CLOSEST = 20; // mm
const FLATTEST = 0.001; // rad from straight above or below
const VIEWS = { corner: [-0.9, 0.42], top: [-Math.PI / 2, Math.PI / 2], front: [-Math.PI / 2, 0], side: [0, 0] };
const PER_PIXEL = 0.006; // rad

export class Orbit {
  constructor(three) {
    this.three = three;
    this.camera = new three.PerspectiveCamera(34, 1, 1, 1e5);
    this.camera.up.set(0, 0, 1);
    this.target = new three.Vector3();
    this.distance = 1000;
    this.height = 1; // of the picture, pixels
    this.look("corner");
  }

  // mm at the target.
  get perPixel() {
    return (2 * this.distance * Math.tan((this.camera.fov * Math.PI) / 360)) / this.height;
  }

  shape(width, height) {
    this.height = height;
    this.camera.aspect = width / height;
    this.update();
  }

  look(view) {
    [this.around, this.above] = VIEWS[view];
    this.update();
  }

  turn(dx, dy) {
    this.around -= dx * PER_PIXEL;
    this.above += dy * PER_PIXEL;
    this.update();
  }

  // By pixels, so that what is at the target stays under the pointer.
  pan(dx, dy) {
    const per = this.perPixel;
    const [right, up] = [0, 1].map((column) => new this.three.Vector3().setFromMatrixColumn(this.camera.matrix, column));
    this.target.addScaledVector(right, -dx * per).addScaledVector(up, dy * per);
    this.update();
  }

  zoom(factor) {
    this.distance = Math.max(CLOSEST, this.distance * factor);
    this.update();
  }

  goTo(place) {
    this.target.copy(place);
    this.update();
  }

  // All boxes are seen: each corner is within the picture from where the camera looks now.
  fit(boxes) {
    const { three, camera } = this;
    const whole = boxes.reduce((sum, box) => sum.union(box), new three.Box3());
    whole.getCenter(this.target);
    this.update();
    const [right, up, back] = [0, 1, 2].map((column) => new three.Vector3().setFromMatrixColumn(camera.matrix, column));
    const high = Math.tan((camera.fov * Math.PI) / 360) * 0.9;
    const wide = high * camera.aspect;
    let distance = CLOSEST;
    for (const { min, max } of boxes) {
      for (let i = 0; i < 8; ++i) {
        const corner = new three.Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z).sub(this.target);
        const nearer = corner.dot(back);
        distance = Math.max(distance, nearer + Math.abs(corner.dot(right)) / wide, nearer + Math.abs(corner.dot(up)) / high);
      }
    }
    this.distance = distance;
    this.update();
  }

  update() {
    const { camera, target, distance } = this;
    this.above = Math.min(Math.max(this.above, FLATTEST - Math.PI / 2), Math.PI / 2 - FLATTEST);
    const [ca, sa] = [Math.cos(this.above), Math.sin(this.above)];
    camera.position.set(target.x + distance * ca * Math.cos(this.around), target.y + distance * ca * Math.sin(this.around), target.z + distance * sa);
    camera.near = distance / 100;
    camera.far = distance * 60;
    camera.lookAt(target);
    camera.updateProjectionMatrix();
    camera.updateMatrix();
  }
}
