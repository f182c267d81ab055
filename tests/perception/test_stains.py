"""Marks on the road told from vehicles."""

import numpy as np

from perception.stains import Stains

FRAME = 40_000_000


def watch(positions, doubtful):
    """Judge one track along x; return whether it is believed and a stain, for each frame."""
    stains = Stains()
    answers = []
    for number, (x, doubt) in enumerate(zip(positions, doubtful, strict=True)):
        believed, stain = stains.judge(
            number * FRAME, np.array([7]), np.array([[x, 0.0]]), np.array([doubt])
        )
        answers.append((bool(believed[0]), bool(stain[0])))
    return answers


def test_what_the_thermal_camera_sees_is_believed_at_once():
    """A track that is not doubtful is a vehicle, standing or not, and remains one."""
    answers = watch([0.0] * 60, [False] + [True] * 59)

    assert set(answers) == {(True, False)}


def test_what_only_the_colour_camera_sees_is_believed_once_it_moves():
    """A doubtful track has to move before it is a vehicle; afterwards it may stand."""
    answers = watch([0.2 * min(f, 10) for f in range(60)], [True] * 60)

    assert answers[0] == (False, False)
    assert answers[-1] == (True, False)


def test_what_never_moves_is_a_stain_after_a_second():
    """A doubtful track that stays where it is becomes a stain, not earlier."""
    answers = watch([0.0] * 30, [True] * 30)

    assert answers[:25] == [(False, False)] * 25
    assert answers[25] == (False, True)


def test_tracks_that_have_ended_are_forgotten():
    """After a second without being seen, an id is doubted anew."""
    stains = Stains()
    here = np.array([7]), np.array([[0.0, 0.0]])
    stains.judge(0, *here, np.array([False]))

    believed, _ = stains.judge(60 * FRAME, *here, np.array([True]))

    assert not believed[0]
