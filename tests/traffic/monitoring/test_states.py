"""What all readers of states have in common."""

from traffic.monitoring.states import match_features, missing_feature


def test_features_are_found_in_both_notations():
    """Brackets and spaces make no difference; what is there twice is told."""
    terms = ["p", "speed(car1)", "dist(a, b)", "x"]
    keys = ["p", "speed[car1]", "dist[ a,b ]", "other", "speed( car1 )"]

    found, twice = match_features(terms, keys)

    assert found == {"p": "p", "speed(car1)": "speed[car1]", "dist(a, b)": "dist[ a,b ]"}
    assert twice == {"speed(car1)": ("speed[car1]", "speed( car1 )")}


def test_the_nearest_name_is_told():
    """A feature that is missing is perhaps called otherwise."""
    assert missing_feature("speed(car1)", ["sped[car1]"]) == "none; did you mean 'sped(car1)'?"
    assert missing_feature("p", ["quite"]) == "none"
