"""A service whose answer may come after its callback has returned."""

import traceback


class Answer:
    """
    The answer to one request, given once, now or later.

    Attributes
    ----------
    response : object
        Of the service's response type; to be filled in.

    """

    def __init__(self, response, send):
        """Belong to one request."""
        self.response = response
        self._send = send
        self._header = None
        self._is_given = False

    def give(self, success, message):
        """Answer; only the first answer counts."""
        if self._is_given:
            return
        self._is_given = True
        self.response.success, self.response.message = success, message
        if self._header is not None:
            self._send(self.response, self._header)

    def address(self, header):
        """Take the request's header, without which nothing can be sent."""
        self._header = header
        if self._is_given:
            self._send(self.response, header)


class LateAnswers:
    """
    A service of rclpy that does not have to answer at once.

    rclpy sends what a callback returns as soon as it returns. A callback that awaits something
    instead keeps rclpy's executor from waiting, and so busy all the time. Here the callback gets
    an `Answer` to keep.

    """

    def __init__(self, node, kind, name, callback):
        """
        Create the service.

        Parameters
        ----------
        node : rclpy.node.Node
        kind : type
            Service type whose response has `success` and `message`.
        name : str
        callback : callable(request, Answer)
            If it raises, the answer says so.

        """
        self.logger = node.get_logger()
        self._callback = callback
        self._service = node.create_service(kind, name, self._called)
        self._send_now = self._service.send_response
        # rclpy hands over what the callback has returned, and here that is an Answer.
        self._service.send_response = lambda answer, header: answer.address(header)

    def _called(self, request, response):
        answer = Answer(response, self._send)
        try:
            self._callback(request, answer)
        except Exception as error:
            self.logger.error(f'{self._service.srv_name}: {error}\n{traceback.format_exc()}')
            answer.give(False, f'internal error: {error}')
        return answer

    def _send(self, response, header):
        try:
            self._send_now(response, header)
        except Exception as error:  # whoever asked has gone
            self.logger.warning(f'{self._service.srv_name}: the answer cannot be sent: {error}')
