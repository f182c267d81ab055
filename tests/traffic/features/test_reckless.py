"""Who was a reckless driver, from when until when."""

import numpy as np

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from tests.support.streams import ms
from traffic.features.reckless import RecklessCar, RecklessCars


def drivers(time: int, *rows: tuple[int, int, int, int]) -> Sample[Table]:
    """Return the table at a time of rows of id, car, beginning and number of acts."""
    ids, cars, since, acts = (np.array([row[i] for row in rows], dtype=np.int64) for i in range(4))
    columns = {"car": cars, "since": since * ms(1), "n_acts": acts, "last_act_at": since * ms(1)}
    return Sample(Table("reckless_driver", ids, columns), ms(time), ms(time))


def test_a_driver_is_told_from_the_first_table_to_the_one_without_it():
    """Who is in the last table still is one; what is known is what was told last."""
    cars = RecklessCars()
    for sample in (
        drivers(0),
        drivers(10, (1, 7, 10, 1)),
        drivers(20, (1, 7, 10, 2), (2, 9, 20, 1)),
        drivers(30, (2, 9, 20, 1)),
    ):
        cars.receive(sample)

    assert cars.found == (
        RecklessCar("reckless_driver1", "car7", ms(10), ms(30), 2, ms(10)),
        RecklessCar("reckless_driver2", "car9", ms(20), None, 1, ms(20)),
    )
