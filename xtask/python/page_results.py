"""Checks the meshes that the scripts of docs/to-a-scene.md made of the inputs of page_inputs.py."""

import itertools

import numpy as np
import pyvista as pv
import SimpleITK as sitk


def check_labels():
    """Volumes within 15 % of those of the voxels, in their place; the formats of images hold the same."""
    image, *others = (sitk.ReadImage("labels." + extension) for extension in ("nii.gz", "nrrd", "mha"))
    labels = sitk.GetArrayFromImage(image)
    for other in others:
        assert np.array_equal(labels, sitk.GetArrayFromImage(other))
        assert np.allclose(image.GetOrigin(), other.GetOrigin())
        assert np.allclose(image.GetDirection(), other.GetDirection())
    mesh = pv.read("labels.vtu")
    volumes = mesh.compute_cell_sizes(length=False, area=False)["Volume"]
    centres = mesh.cell_centers().points
    for label in (1, 2):
        voxels = np.argwhere(labels == label)[:, ::-1]
        expected = len(voxels) * np.prod(image.GetSpacing()) * 1e-9
        inside = mesh["labels"] == label
        found = volumes[inside].sum()
        assert abs(found / expected - 1) < 0.15, f"label {label}: {found} m3, {expected} in the image"
        middle = image.TransformContinuousIndexToPhysicalPoint(voxels.mean(axis=0).tolist())
        centre = np.average(centres[inside], axis=0, weights=volumes[inside])
        assert np.allclose(centre, np.array(middle) / 1000, atol=5e-4), f"label {label}: {centre}, not {middle}"


def check_split():
    """Triangles are faces of tetrahedra, and nothing is lost."""
    whole, mesh = pv.read("bricks.vtu"), pv.read("tets.vtu")
    tets, triangles = mesh.cells_dict[pv.CellType.TETRA], mesh.cells_dict[pv.CellType.TRIANGLE]
    faces = {tuple(sorted(face)) for tet in tets.tolist() for face in itertools.combinations(tet, 3)}
    assert len(triangles) == 2 * len(whole.cells_dict[pv.CellType.QUAD])
    assert all(tuple(sorted(triangle)) in faces for triangle in triangles.tolist())
    assert abs(mesh.volume / whole.volume - 1) < 1e-6
    assert np.count_nonzero(mesh["group skin"]) == len(triangles)


check_labels()
check_split()
