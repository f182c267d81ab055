"""Images are made again exactly as they were."""

import pytest
from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from mcap.reader import make_reader

from perception.overlay import jpeg_from
from traffic.errors import ExplanationError
from traffic.explaining.images import images_again
from traffic.explaining.kept import open_kept_run
from traffic.recording.views import JPEG_QUALITY

pytestmark = [pytest.mark.sumo, pytest.mark.slow]


def jpegs_of(path, label):
    """Return the images of a recording, in their order."""
    with path.open("rb") as file:
        messages = make_reader(file).iter_messages(topics=[f"view/{label}"])
        return [CompressedImage.FromString(each[2].data).data for each in messages]


@pytest.mark.parametrize("label", ["colour_images", "thermal_images"])
def test_an_image_made_again_is_the_same(filmed_run, label):
    """To the last pixel, however many images have been passed over."""
    walker = filmed_run.walker
    numbers = [3, 30]

    found = images_again(
        walker.run, label, numbers, (walker.road_map, walker.camera), lambda *_: None
    )

    recorded = jpegs_of(filmed_run.recording, label)
    assert sorted(found) == numbers
    for number, image in found.items():
        assert jpeg_from(image, JPEG_QUALITY) == recorded[number]


def test_another_simulation_is_never_taken_for_it(filmed_run, tmp_path):
    """If the vehicles are not those that were filmed, it says so."""
    folder = tmp_path / "run"
    folder.symlink_to(filmed_run.walker.run.folder)
    run = open_kept_run(folder)
    request = {**run.origin.request, "seed": 77}
    run.__dict__["origin"] = run.origin.model_copy(update={"request": request})
    walker = filmed_run.walker

    with pytest.raises(ExplanationError, match=r"cannot be made again: at 0.00 s the vehicles"):
        images_again(run, "colour_images", [5], (walker.road_map, walker.camera), lambda *_: None)
