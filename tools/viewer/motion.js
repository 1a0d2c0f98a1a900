// Where bodies stand at a crank angle: the same law as cqdd_design/solids/poses.py, lengths in metres.

export function crankPhase(mechanism, disc) {
  return (2 * Math.PI * disc) / mechanism.discCount;
}

// Rotation about the axis (rad) and place of a body; perfect parts without load.
export function bodyPose(mechanism, body, disc, crankAngle) {
  if (body === "shaft") {
    return { angle: crankAngle, x: 0, y: 0 };
  }
  if (body === "carrier") {
    return { angle: -crankAngle / mechanism.ratio, x: 0, y: 0 };
  }
  if (body === "disc") {
    const turned = crankAngle + crankPhase(mechanism, disc);
    return {
      angle: -turned / mechanism.ratio,
      x: mechanism.eccentricity * Math.cos(turned),
      y: mechanism.eccentricity * Math.sin(turned),
    };
  }
  return { angle: 0, x: 0, y: 0 };
}
