/** The body's shadow on its surroundings, from a light straight above. It shows where the body is over the ground. */

import {
  Color, DepthTexture, DoubleSide, LessEqualCompare, LinearFilter, Matrix4, Mesh, MeshBasicMaterial, OrthographicCamera,
  Scene, Vector3, WebGLRenderTarget,
} from 'three';

const SIZE = 384;
const MARGIN = 1.05;

export class Shadow {
  /** @param {import('./surface.js').Surface} body @param {import('./surface.js').Surface} ground */
  constructor(body, ground) {
    this.body = body;
    this.camera = new OrthographicCamera();
    this.caster = new Mesh(body.mesh.geometry, new MeshBasicMaterial({ colorWrite: false, side: DoubleSide }));
    this.caster.frustumCulled = false;
    this.caster.matrixAutoUpdate = false;
    this.scene = new Scene();
    this.scene.add(this.caster);
    const depth = new DepthTexture(SIZE, SIZE);
    depth.compareFunction = LessEqualCompare;
    depth.minFilter = LinearFilter;
    depth.magFilter = LinearFilter;
    this.target = new WebGLRenderTarget(SIZE, SIZE, { depthTexture: depth });
    this.matrix = new Matrix4();
    this.drawn = null;
    const { uniforms } = ground.quick;
    uniforms.shadowMap.value = depth;
    uniforms.shadowMatrix.value = this.matrix;
  }

  /** Looks down on a box around the body's middle and on everything below it. */
  aim(reach, surroundings) {
    const { camera } = this;
    const middle = this.body.mesh.position;
    const half = reach.getSize(new Vector3()).multiplyScalar(0.5 * MARGIN);
    const top = middle.z + half.z;
    camera.left = -half.x;
    camera.right = half.x;
    camera.bottom = -half.y;
    camera.top = half.y;
    camera.near = 0;
    camera.far = Math.max(2 * half.z, 1.01 * (top - surroundings.min.z));
    camera.position.set(middle.x, middle.y, top);
    camera.up.set(0, 1, 0);
    camera.lookAt(middle.x, middle.y, top - 1);
    camera.updateMatrixWorld();
    camera.updateProjectionMatrix();
    this.matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  }

  /** Draws the shadow map again if the body has changed. */
  update(renderer, reach, surroundings) {
    const { position, quaternion } = this.body.mesh;
    const key = [position.x, position.y, position.z, quaternion.x];
    const { shown } = this.body;
    if (this.drawn?.shown === shown && key.every((value, i) => value === this.drawn.key[i])) return;
    this.drawn = { shown, key };
    this.aim(reach, surroundings);
    this.body.mesh.updateMatrix();
    this.caster.matrix.copy(this.body.mesh.matrix);
    const clear = renderer.getClearColor(new Color());
    renderer.setRenderTarget(this.target);
    renderer.render(this.scene, this.camera);
    renderer.setRenderTarget(null);
    renderer.setClearColor(clear);
  }
}
