"""What to tell a user about an error, if the user can do something about it.

The errors are imported when one has happened, so that a command without one starts at once.
"""

__all__ = ["complaint_about"]


def complaint_about(error: BaseException) -> str | None:
    """Return the message for an error that the input or the system is to blame for.

    An error that a knowledge process failed with is judged by its cause. None means a bug.
    """
    from dyknow.errors import (
        DyKnowError,
        FeatureError,
        ProcessError,
        SpecificationError,
        SpecificationErrors,
    )
    from networks.errors import NetworkError
    from perception.errors import PerceptionError
    from traffic.errors import TrafficError

    match error:
        case SpecificationErrors():
            return "\n".join(complaint_about(fault) or str(fault) for fault in error.exceptions)
        case SpecificationError():
            return error.report()
        case ProcessError():
            cause = error.__cause__
            complaint = complaint_about(cause) if cause is not None else None
            return f"{error}: {complaint}" if isinstance(cause, FeatureError) else complaint
        case DyKnowError() | NetworkError() | PerceptionError() | TrafficError():
            return f"traffic: {error}"
        case OSError(strerror=str(reason)):
            place = f"{error.filename}: " if error.filename is not None else ""
            return f"traffic: {place}{reason}"
        case _:
            return None
