"""What photohull raises. Each message is one sentence: what was found where, and what to do."""


class Error(RuntimeError):
    """The job cannot be done with this input, or on this machine."""


class UsageError(Error, ValueError):
    """An option or an argument is wrong, or does not go with another one."""


class OutOfMemory(Error, MemoryError):
    """What would have been done does not fit into memory."""


class DeviceError(Error):
    """The graphics device is lost, or out of memory."""


class Cancelled(Error):
    """The job was asked to stop."""
