"""From pixels to located vision percepts.

Modules, in reading order:

- `errors`: what perception raises on purpose;
- `camera`: the pinhole camera of a hovering aircraft, world to image and back;
- `columns`: records whose fields are arrays of equal length;
- `scene`: what can be seen: the ground, what stands beside the roads, vehicles;
- `shapes`: vehicles and houses as flat faces in space;
- `painting`: the ground, painted once for each pose of the camera;
- `lamps`: the lamps of traffic lights, drawn and read;
- `rendering`: a scene as the colour camera and the thermal camera see it;
- `blobs`: connected regions of an image that differ from the background;
- `background`: what the empty road looks like, learned from pixels;
- `locating`: a blob on the ground, with its uncertainty;
- `fusion`: one list of sightings from both cameras;
- `kalman`: a filter of constant velocity for many objects at once;
- `assignment`: which of two groups belong together;
- `tracking`: blobs kept apart from frame to frame;
- `joining`: the pieces of one tracked vehicle made one;
- `splitting`: blobs that cover several vehicles, cut into parts;
- `stains`: marks on the road told from vehicles;
- `pipeline`: all of this, from two images to percepts;
- `overlay`: what the system believes, drawn onto the images;
- `web_films`: such films as web browsers play them;
- `processes`: cameras and perception as knowledge processes.
"""

from perception.camera import Calibration, Camera
from perception.errors import CalibrationError, PerceptionError
from perception.pipeline import Pipeline, PipelineSettings
from perception.scene import Ground, Surroundings, Vehicles, build_surroundings

__all__ = [
    "Calibration",
    "CalibrationError",
    "Camera",
    "Ground",
    "PerceptionError",
    "Pipeline",
    "PipelineSettings",
    "Surroundings",
    "Vehicles",
    "build_surroundings",
]
